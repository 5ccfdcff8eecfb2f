#include "evert/integrators/damping_solver.hpp"

#include "evert/core/error.hpp"
#include "evert/core/log.hpp"

#include "damping_options.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace evert {
namespace {

/// Owned values of a Vec, for the life of the object.
class VecView {
 public:
  explicit VecView(Vec vec) : vec_(vec) {
    PetscInt size = 0;
    check(VecGetLocalSize(vec, &size));
    check(VecGetArray(vec, &data_));
    size_ = static_cast<std::size_t>(size);
  }
  ~VecView() { static_cast<void>(VecRestoreArray(vec_, &data_)); }
  VecView(const VecView&) = delete;
  VecView& operator=(const VecView&) = delete;
  [[nodiscard]] std::span<double> values() const { return {data_, size_}; }

 private:
  Vec vec_;
  PetscScalar* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace

DampingSolver::DampingSolver(const DistributedMesh& mesh, const ElasticForces& elastic)
    : mesh_(mesh), elastic_(elastic) {
  check(VecCreateMPI(mesh.comm, 3 * mesh.owned_nodes, PETSC_DETERMINE, residual_.out()));
  check(VecSetBlockSize(residual_.get(), 3));
  check(VecDuplicate(residual_.get(), projected_.out()));
  check(VecDuplicate(residual_.get(), correction_.out()));
  if (elastic.damped()) create_ksp();
}

void DampingSolver::create_ksp() {
  operator_ = std::make_unique<DampingOperator>(mesh_, elastic_);
  const auto type = damping_matrix_type(mesh_.comm);
  ksp_ = damping_ksp(mesh_.comm, type);
  if (type != "shell") assembled_ = std::make_unique<AssembledDamping>(*operator_, type.c_str());
  const Mat mat = assembled_ != nullptr ? assembled_->mat() : operator_->mat();
  if (assembled_ != nullptr) {
    operator_->set(0, {});
    assembled_->assemble();
    try_set_up(mat, type);
  }
  check(KSPSetOperators(ksp_.get(), mat, mat));
  check(KSPGetTolerances(ksp_.get(), &rtol_, &atol_, nullptr, nullptr));
  check(VecDuplicate(residual_.get(), last_.out()));
  check(VecDuplicate(residual_.get(), image_.out()));
}

void DampingSolver::print_options(MPI_Comm comm) {
  static_cast<void>(damping_ksp(comm, damping_matrix_type(comm)));
}

void DampingSolver::invalidate() {
  if (operator_ != nullptr) operator_->invalidate();
}

void DampingSolver::add_damping(Vec v, Vec out, double factor) const {
  if (operator_ != nullptr) operator_->add_damping(v, out, factor);
}

/// residual_ = b − (M + s C) v.
void DampingSolver::residual(double s, Vec b, const NodeField& v) {
  {
    const VecView result(residual_.get());
    const VecView right(b);
    const auto mass = elastic_.masses();
    const auto velocity = v.owned();
    for (std::size_t i = 0; i < velocity.size(); ++i)
      result.values()[i] = right.values()[i] - mass[i / 3] * velocity[i];
  }
  add_damping(v.vec(), residual_.get(), -s);
}

int DampingSolver::solve(double s, Vec b, NodeField& v, std::span<const NodeConstraint> constraints,
                         DampingStart start) {
  const PhaseScope scope(Phase::damping_solve);
  impose(constraints, v.owned());
  v.touched();
  residual(s, b, v);
  check(VecCopy(residual_.get(), projected_.get()));
  {
    const VecView right(projected_.get());
    project(constraints, right.values());
  }
  int iterations = 0;
  if (operator_ != nullptr) {
    operator_->set(s, constraints);
    if (assembled_ != nullptr) assembled_->assemble();
    iterations = correct(start);
  } else {
    const VecView right(projected_.get());
    const VecView change(correction_.get());
    const auto mass = elastic_.masses();
    for (std::size_t i = 0; i < right.values().size(); ++i)
      change.values()[i] = right.values()[i] / mass[i / 3];
  }
  check(VecAXPY(v.vec(), 1.0, correction_.get()));
  impose(constraints, v.owned());  // the correction has rounding in constrained directions
  v.touched();
  return iterations;
}

/// A correction = projected residual.
int DampingSolver::correct(DampingStart start) {
  double along = 0;
  if (start == DampingStart::along_last) along = go_along_last();
  if (start == DampingStart::unknown) reference_ = 0;
  const int iterations = iterate();
  if (along != 0) check(VecAXPY(correction_.get(), along, last_.get()));
  return iterations;
}

/// Takes what the last correction d explains off the projected residual r: a d with a = d·r / d·A d, the best
/// multiple in the norm of A. Returns a. The tolerance stays relative to all of r.
double DampingSolver::go_along_last() {
  reference_ = norm_of(projected_.get());
  std::swap(last_, correction_);
  {
    const VecView last(last_.get());
    project(operator_->constraints(), last.values());
  }
  Mat mat = nullptr;
  check(KSPGetOperators(ksp_.get(), &mat, nullptr));
  check(MatMult(mat, last_.get(), image_.get()));
  std::array<PetscScalar, 2> products{};
  const std::array<Vec, 2> vectors{projected_.get(), image_.get()};
  check(VecMDot(last_.get(), 2, vectors.data(), products.data()));
  if (!(products[1] > 0)) return 0;
  const double along = products[0] / products[1];
  check(VecAXPY(projected_.get(), -along, image_.get()));
  return along;
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
  return static_cast<int>(iterations);
}

std::span<const double> DampingSolver::reaction(double s) {
  // What was left over before the correction, less what the correction brought: A δ has no mass term in
  // constrained directions, where δ = 0.
  check(VecScale(residual_.get(), -1.0));
  add_damping(correction_.get(), residual_.get(), s);
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(residual_.get(), &values));
  const std::span<const double> result(values, 3 * static_cast<std::size_t>(mesh_.owned_nodes));
  check(VecRestoreArrayRead(residual_.get(), &values));
  return result;
}

}  // namespace evert
