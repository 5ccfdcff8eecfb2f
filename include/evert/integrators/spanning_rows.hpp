#pragma once
#include "evert/core/index.hpp"
#include "evert/core/petsc.hpp"
#include "evert/math/vec3.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <array>
#include <span>
#include <vector>

namespace evert {

/// The part of a RowSystem whose rows share nodes with those of other ranks: S as a PETSc matrix over all
/// ranks, and its solver, with option prefix `projection_`. By default a direct one, Cholesky's by MUMPS.
class SpanningRows {
 public:
  using Nodes = std::array<LocalIndex, 4>;
  using Coefficients = std::array<Vec3d, 4>;

  /// Collective. `rows`: numbers of this rank's rows in `nodes`, which must outlive this. Throws UserError
  /// for options that cannot work.
  SpanningRows(const DistributedMesh& mesh, std::span<const Nodes> nodes, std::vector<std::int32_t> rows);

  /// Collective. Reads the options where there are no such rows: they are checked on any number of ranks, and
  /// printed with -help.
  static void read_options(MPI_Comm comm);

  /// Collective. S of the rows `j`, of `jw` = j W, and of compliances, one a row of `nodes` each.
  void assemble(std::span<const Coefficients> j, std::span<const Coefficients> jw,
                std::span<const double> compliances);
  /// Collective. Replaces the values of the rows in `b` by those of S⁻¹ b. Throws SimulationError where the
  /// solver does not converge.
  void solve(std::span<double> b);

  [[nodiscard]] Mat mat() const { return product_.get(); }

 private:
  void fill(Mat mat, std::span<const Coefficients> values);

  const DistributedMesh& mesh_;
  std::span<const Nodes> nodes_;
  std::vector<std::int32_t> rows_;
  MatHandle transposed_, moved_, product_;  // Jᵀ, W Jᵀ, S
  VecHandle diagonal_, right_, solution_;
  KspHandle ksp_;
};

}  // namespace evert
