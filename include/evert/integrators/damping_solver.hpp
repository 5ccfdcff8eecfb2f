#pragma once
#include "evert/integrators/damping_matrix.hpp"
#include "evert/integrators/damping_operator.hpp"

#include <memory>
#include <span>

namespace evert {

/// What a solve may know beforehand of the change of velocity that it looks for.
enum class DampingStart {
  unknown,     ///< nothing
  along_last,  ///< it resembles that of the last solve, up to its size
  refinement,  ///< the last solve again, with other constraints or another right side
};

/// Solves (M + s C) v = b for the velocities of the unconstrained directions, by PETSc's conjugate gradients
/// with option prefix `damping_`.  PHYSICS 5
///
/// `-damping_mat_type shell|baij|sbaij|aij` chooses the operator (default shell, matrix-free, preconditioned
/// by its point blocks); all of PETSc's `-damping_ksp_*` and `-damping_pc_*` apply. `-damping_ksp_rtol` is
/// relative to the residual of the starting guess, that is to the change of momentum that the step asks for.
class DampingSolver {
 public:
  /// Collective. Reads the options; throws UserError for one that cannot work.
  DampingSolver(const DistributedMesh& mesh, const ElasticForces& elastic);

  /// Collective. With -help: makes PETSc print what the solver can be told.
  static void print_options(MPI_Comm comm);

  /// Collective. C has changed: call after every force update.
  void invalidate();

  /// Collective. On entry `v` is the velocity before; on return v = P v + prescribed with P (M + s C) v = P
  /// b. A refinement takes the tolerance of the solve that it refines, not one relative to the little that is
  /// left. Returns the number of iterations. Throws SimulationError when PETSc reports divergence.
  int solve(double s, Vec b, NodeField& v, std::span<const NodeConstraint> constraints,
            DampingStart start = DampingStart::unknown);

  /// Collective. (M + s C) v − b of the last solve: what the constraints exerted [N s]. Owned nodes, valid at
  /// constrained nodes only.
  [[nodiscard]] std::span<const double> reaction(double s);

  /// Collective. `out` += factor · C v.
  void add_damping(Vec v, Vec out, double factor) const;

  [[nodiscard]] bool damped() const { return operator_ != nullptr; }

 private:
  void create_ksp();
  void residual(double s, Vec b, const NodeField& v);
  int correct(DampingStart start);
  double go_along_last();
  [[nodiscard]] double norm_of(Vec residual);
  int iterate();

  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  std::unique_ptr<DampingOperator> operator_;    // none where nothing is damped: the solve is then a division
  std::unique_ptr<AssembledDamping> assembled_;  // with -damping_mat_type other than shell
  KspHandle ksp_;
  VecHandle residual_, projected_, correction_;
  VecHandle last_, image_;  // the last correction, and scratch; only where something is damped
  double rtol_ = 0, atol_ = 0;
  double reference_ = 0;  // the norm that rtol_ is relative to in a refinement
};

}  // namespace evert
