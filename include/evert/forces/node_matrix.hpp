#pragma once
#include "evert/core/petsc.hpp"
#include "evert/forces/elastic_forces.hpp"

#include <functional>
#include <span>
#include <vector>

namespace evert {

/// An assembled PETSc matrix of 3×3 blocks that couple the nodes of cells, filled cell by cell. The pattern
/// is made once; the rigid-body modes of the rest shape are attached as near null space, for multigrid.
class NodeMatrix {
 public:
  /// Collective. `type` is "baij", "sbaij" or "aij"; the pattern couples the nodes of the cells of every
  /// block that `takes_part`, and every node with itself.
  NodeMatrix(const DistributedMesh& mesh, const ElasticForces& elastic, const char* type,
             const std::function<bool(const ElasticBlock&)>& takes_part);

  /// Collective. What solvers may count on, until told otherwise; any matrix here is symmetric.
  void declare_positive_definite(bool is);
  /// Collective.
  void begin();
  /// Not collective. Adds the dense row-major `matrix` of the nodes `cell` (local numbers).
  void add(const CellNodes& cell, std::span<const double> matrix);
  /// Not collective. Adds the 3×3 `block` to the diagonal block of an owned node.
  void add_diagonal(LocalIndex node, std::span<const double, 9> block);
  /// Collective.
  void end();
  [[nodiscard]] Mat mat() const { return mat_.get(); }

 private:
  void preallocate(const ElasticForces& elastic, const char* type,
                   const std::function<bool(const ElasticBlock&)>& takes_part);
  void attach_rigid_body_modes();
  void add_rows(Mat mat, std::span<const double> matrix);
  [[nodiscard]] GlobalIndex global_number(PetscInt local) const;

  const DistributedMesh& mesh_;
  bool knows_spd_ = false;
  bool upper_only_;             // sbaij stores the upper triangle
  std::vector<PetscInt> rows_;  // scratch: the nodes to add at
  MatHandle mat_;
};

}  // namespace evert
