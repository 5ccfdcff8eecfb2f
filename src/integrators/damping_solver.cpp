#include "evert/integrators/damping_solver.hpp"

#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include "damping_options.hpp"
#include "vec_view.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

namespace evert {
namespace {

/// to = −from, in one pass.
void set_to_negative(Vec to, Vec from) {
  const VecView negative(to);
  const VecView values(from);
  std::transform(values.values().begin(), values.values().end(), negative.values().begin(), std::negate());
}

/// Of the residual that the last solve started from.
double first_norm(KSP ksp) {
  const PetscReal* norms = nullptr;
  PetscInt count = 0;
  check(KSPGetResidualHistory(ksp, &norms, &count));
  return count > 0 ? norms[0] : 0.0;
}

}  // namespace

DampingSolver::DampingSolver(const DistributedMesh& mesh, const ElasticForces& elastic,
                             ImplicitStrains* strains)
    : DampingSolver(mesh, elastic, strains, Damping::implicit) {}

DampingSolver DampingSolver::without_damping(const DistributedMesh& mesh, const ElasticForces& elastic,
                                             ImplicitStrains* strains) {
  return {mesh, elastic, strains, Damping::left_out};
}

DampingSolver::DampingSolver(const DistributedMesh& mesh, const ElasticForces& elastic,
                             ImplicitStrains* strains, Damping damping)
    : mesh_(mesh), elastic_(elastic), strains_(strains) {
  check(VecCreateMPI(mesh.comm, 3 * mesh.owned_nodes, PETSC_DETERMINE, reaction_.out()));
  check(VecSetBlockSize(reaction_.get(), 3));
  check(VecDuplicate(reaction_.get(), projected_.out()));
  check(VecDuplicate(reaction_.get(), correction_.out()));
  if (damping == Damping::implicit && elastic.couples_velocities()) create_ksp();
}

void DampingSolver::create_ksp() {
  operator_ = std::make_unique<DampingOperator>(mesh_, elastic_, strains_);
  const auto type = damping_matrix_type(mesh_.comm);
  ksp_ = damping_ksp(mesh_.comm, type);
  if (type != "shell") assembled_ = std::make_unique<AssembledDamping>(*operator_, type.c_str());
  const Mat mat = assembled_ != nullptr ? assembled_->mat() : operator_->mat();
  if (assembled_ != nullptr) {
    operator_->set(0, {});
    assembled_->assemble();
    try_damping_set_up(mat, type);
  }
  check(KSPSetOperators(ksp_.get(), mat, mat));
  check(KSPGetTolerances(ksp_.get(), &rtol_, &atol_, nullptr, nullptr));
  check(KSPSetResidualHistory(ksp_.get(), nullptr, 1, PETSC_TRUE));  // the first norm, for refine()
  check(VecDuplicate(reaction_.get(), direction_.out()));
  check(VecDuplicate(reaction_.get(), image_.out()));
}

void DampingSolver::print_options(MPI_Comm comm) {
  static_cast<void>(damping_ksp(comm, damping_matrix_type(comm)));
}

void DampingSolver::invalidate() {
  if (operator_ != nullptr) operator_->invalidate();
}

void DampingSolver::add_damping(Vec v, Vec out, double factor) const {
  if (operator_ != nullptr && elastic_.damped()) operator_->add_damping(v, out, factor);
}

int DampingSolver::solve(double s, Vec b, NodeField& v, std::span<const NodeConstraint> constraints,
                         Vec along) {
  const PhaseScope scope(Phase::damping_solve);
  factor_ = s;
  impose(constraints, v.owned());
  v.touched();
  set_to_negative(reaction_.get(), b);
  react_to_velocity(v.vec());
  reference_ = 0;
  return correct(v, constraints, along);
}

int DampingSolver::refine(NodeField& v, std::span<const NodeConstraint> constraints) {
  const PhaseScope scope(Phase::damping_solve);
  static_cast<void>(reaction());
  if (impose_now(v, constraints)) react_to_change(correction_.get());
  return correct(v, constraints, nullptr);
}

std::span<double> DampingSolver::reaction() {
  if (!reacted_) react_to_change(correction_.get());
  reacted_ = true;
  const VecView view(reaction_.get());
  return view.values();
}

void DampingSolver::carry_over(Vec b, NodeField& v) {
  if (strains_ == nullptr) return;
  strains_->add_product(correction_.get(), b, -1);
  check(VecAXPY(v.vec(), 1.0, correction_.get()));
  v.touched();
}

/// reaction_ += (M + s C + θΔt² K_s) change
void DampingSolver::react_to_change(Vec change) {
  react_to_velocity(change);
  if (strains_ != nullptr) strains_->add_product(change, reaction_.get(), 1);
}

/// reaction_ += (M + s C) velocity
void DampingSolver::react_to_velocity(Vec velocity) {
  if (elastic_.consistent_mass() != nullptr) {
    operator_->add_momentum_and_damping(velocity, reaction_.get(), factor_);
    return;
  }
  {
    const VecView sum(reaction_.get());
    const VecView of_nodes(velocity);
    const auto mass = elastic_.masses();
    for (std::size_t i = 0; i < sum.values().size(); ++i)
      sum.values()[i] += mass[i / 3] * of_nodes.values()[i];
  }
  add_damping(velocity, reaction_.get(), factor_);
}

/// Imposes the constraints; correction_ = the change of `v`. Collective: whether any rank's changed by more
/// than rounding, as it does where a node is held that was free.
bool DampingSolver::impose_now(NodeField& v, std::span<const NodeConstraint> constraints) {
  constexpr double rounding = 1e-12;
  check(VecSet(correction_.get(), 0.0));
  const VecView change(correction_.get());
  int changed = 0;
  for (const auto& c : constraints) {
    const auto before = node_value(v.owned(), c.node);
    const auto after = c.free * before + c.prescribed;
    if (norm(after - before) > rounding * (norm(before) + norm(after))) changed = 1;
    set_node_value(change.values(), c.node, after - before);
    set_node_value(v.owned(), c.node, after);
  }
  v.touched();
  MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, mesh_.comm);
  return changed != 0;
}

/// Takes −P reaction_ off by changing `v` in the free directions.
int DampingSolver::correct(NodeField& v, std::span<const NodeConstraint> constraints, Vec along) {
  set_to_negative(projected_.get(), reaction_.get());
  {
    const VecView right(projected_.get());
    project(constraints, right.values());
  }
  int iterations = 0;
  if (operator_ != nullptr) {
    operator_->set(factor_, constraints);
    if (assembled_ != nullptr) assembled_->assemble();
    const double multiple = along != nullptr ? go_along(along) : 0.0;
    iterations = iterate();
    if (multiple != 0) check(VecAXPY(correction_.get(), multiple, direction_.get()));
  } else if (strains_ != nullptr) {
    strains_->solve(projected_.get(), correction_.get(), constraints);
  } else {
    const VecView right(projected_.get());
    const VecView change(correction_.get());
    const auto mass = elastic_.masses();
    for (std::size_t i = 0; i < right.values().size(); ++i)
      change.values()[i] = right.values()[i] / mass[i / 3];
  }
  reacted_ = false;
  check(VecAXPY(v.vec(), 1.0, correction_.get()));
  impose(constraints, v.owned());  // the correction has rounding in constrained directions
  v.touched();
  return iterations;
}

/// Takes off the projected residual r what a multiple of d, the free part of `direction`, does to it: a A d
/// with a = d·r / d·A d, the best in the norm of A. Returns a. The tolerance stays relative to all of r.
double DampingSolver::go_along(Vec direction) {
  reference_ = norm_of(projected_.get());
  check(VecCopy(direction, direction_.get()));
  {
    const VecView free(direction_.get());
    project(operator_->constraints(), free.values());
  }
  Mat mat = nullptr;
  check(KSPGetOperators(ksp_.get(), &mat, nullptr));
  check(MatMult(mat, direction_.get(), image_.get()));
  std::array<PetscScalar, 2> products{};
  const std::array<Vec, 2> vectors{projected_.get(), image_.get()};
  check(VecMDot(direction_.get(), 2, vectors.data(), products.data()));
  if (!(products[1] > 0)) return 0;
  const double multiple = products[0] / products[1];
  check(VecAXPY(projected_.get(), -multiple, image_.get()));
  return multiple;
}

/// As the KSP measures a residual.
double DampingSolver::norm_of(Vec residual) {
  KSPNormType type = KSP_NORM_DEFAULT;
  check(KSPSetUp(ksp_.get()));
  check(KSPGetNormType(ksp_.get(), &type));
  PetscReal norm = 0;
  if (type == KSP_NORM_UNPRECONDITIONED) {
    check(VecNorm(residual, NORM_2, &norm));
  } else if (type != KSP_NORM_NONE) {
    PC pc = nullptr;
    check(KSPGetPC(ksp_.get(), &pc));
    check(PCApply(pc, residual, image_.get()));
    PetscScalar natural = 0;
    if (type == KSP_NORM_NATURAL)
      check(VecDot(residual, image_.get(), &natural));
    else
      check(VecNorm(image_.get(), NORM_2, &norm));
    norm = std::max(norm, std::sqrt(std::abs(natural)));
  }
  return norm;
}

/// Conjugate gradients from zero.
int DampingSolver::iterate() {
  check(
      KSPSetTolerances(ksp_.get(), rtol_, std::max(atol_, rtol_ * reference_), PETSC_DEFAULT, PETSC_DEFAULT));
  check(KSPSolve(ksp_.get(), projected_.get(), correction_.get()));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check(KSPGetConvergedReason(ksp_.get(), &reason));
  check(KSPGetIterationNumber(ksp_.get(), &iterations));
  if (reason == KSP_DIVERGED_NANORINF)
    throw SimulationError(
        "the damping solve met a force or a coefficient that is not finite (DIVERGED_NANORINF); a smaller "
        "integrator.time_step or softer materials may help");
  if (reason < 0)
    throw SimulationError(
        "the damping solve did not converge (" + std::string(KSPConvergedReasons[reason]) + " after " +
        std::to_string(iterations) +
        " iterations); a smaller integrator.time_step, another -damping_pc_type or a larger "
        "-damping_ksp_max_it may help");
  if (reference_ == 0) reference_ = first_norm(ksp_.get());
  return static_cast<int>(iterations);
}

}  // namespace evert
