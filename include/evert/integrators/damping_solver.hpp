#pragma once
#include "evert/integrators/damping_matrix.hpp"
#include "evert/integrators/damping_operator.hpp"

#include <memory>
#include <span>

namespace evert {

/// Solves (M + s C) v = b for the velocities of the unconstrained directions, by PETSc's conjugate gradients
/// with option prefix `damping_`.  PHYSICS 5
///
/// With implicit strains it solves (M + s C) v + θΔt² K_s (v − v₀) = b, v₀ what it starts from: without
/// damping directly, else with K_s in the operator.
///
/// `-damping_mat_type shell|baij|sbaij|aij` chooses the operator (default shell, matrix-free, preconditioned
/// by its point blocks); all of PETSc's `-damping_ksp_*` and `-damping_pc_*` apply. `-damping_ksp_rtol` is
/// relative to the residual of the starting guess, that is to the change of momentum that the step asks for,
/// in the norm of the preconditioner (PETSc's natural one) where the method knows it.
class DampingSolver {
 public:
  /// Collective. Reads the options; throws UserError for one that cannot work.
  /// `strains` may be null; they are to be prepared before each solve.
  DampingSolver(const DistributedMesh& mesh, const ElasticForces& elastic,
                ImplicitStrains* strains = nullptr);

  /// Collective. One for schemes that put damping on the right-hand side: C is taken for zero whatever is
  /// damped, a solve is a division by the masses, which must be lumped, but for `strains`, and no options are
  /// read.
  [[nodiscard]] static DampingSolver without_damping(const DistributedMesh& mesh,
                                                     const ElasticForces& elastic,
                                                     ImplicitStrains* strains = nullptr);

  /// Collective. With -help: makes PETSc print what the solver can be told.
  static void print_options(MPI_Comm comm);

  /// Collective. C has changed: call after every force update.
  void invalidate();

  /// Collective. On entry `v` is the velocity before; on return v = P v + prescribed with P (M + s C) v = P
  /// b. `along`: what the change of velocity is expected to resemble, up to its size; nullptr where nothing
  /// is known. Returns the number of iterations. Throws SimulationError when PETSc reports divergence.
  int solve(double s, Vec b, NodeField& v, std::span<const NodeConstraint> constraints, Vec along = nullptr);

  /// Collective. What the constraints exerted in the last solve, its left-hand side less b per owned node [N
  /// s]; beside the constrained directions it is what the tolerance has left. Take an impulse off it to add
  /// that to b, and then refine().
  [[nodiscard]] std::span<double> reaction();

  /// Collective. The last solve again, from the velocities that it found, for other constraints and for what
  /// was put into its reaction(). Keeps the tolerance of that solve: not relative to the little that is left.
  /// Costs one product less.
  int refine(NodeField& v, std::span<const NodeConstraint> constraints);

  /// Collective. With implicit strains, for the second solve of a step whose first was the last: `b` has the
  /// impulse of both, `v` is the velocity before the first. Takes off `b` what K_s withheld there, and `v` to
  /// where the first solve took it, so that each impulse meets K_s once, at its own positions: else angular
  /// momentum is not kept. To be called before the strains are prepared for the second.
  void carry_over(Vec b, NodeField& v);

  /// Collective. `out` += factor · C v.
  void add_damping(Vec v, Vec out, double factor) const;
  /// Collective. Of consistent masses: `out` += M v.
  void add_momentum(Vec v, Vec out) const { operator_->add_momentum(v, out); }

  /// False where a solve is a division by the lumped masses.
  [[nodiscard]] bool iterates() const { return operator_ != nullptr; }

 private:
  enum class Damping { implicit, left_out };
  DampingSolver(const DistributedMesh& mesh, const ElasticForces& elastic, ImplicitStrains* strains,
                Damping damping);
  void create_ksp();
  int correct(NodeField& v, std::span<const NodeConstraint> constraints, Vec along);
  double go_along(Vec direction);
  [[nodiscard]] double norm_of(Vec residual);
  int iterate();
  bool impose_now(NodeField& v, std::span<const NodeConstraint> constraints);
  void react_to_velocity(Vec velocity);
  void react_to_change(Vec change);

  const DistributedMesh& mesh_;
  const ElasticForces& elastic_;
  ImplicitStrains* strains_;
  std::unique_ptr<DampingOperator> operator_;    // none where iterates() is false
  std::unique_ptr<AssembledDamping> assembled_;  // with -damping_mat_type other than shell
  KspHandle ksp_;
  VecHandle reaction_, projected_, correction_;
  VecHandle direction_, image_;  // of go_along() and its product, only where iterates()
  bool reacted_ = true;          // reaction_ knows of correction_
  double factor_ = 0;            // s of the last solve
  double rtol_ = 0, atol_ = 0;
  double reference_ = 0;  // the norm that rtol_ is relative to; 0 for that of the starting residual
};

}  // namespace evert
