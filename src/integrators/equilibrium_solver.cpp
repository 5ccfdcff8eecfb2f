#include "evert/integrators/equilibrium_solver.hpp"

#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include "equilibrium_options.hpp"
#include "linear_solver_options.hpp"
#include "vec_view.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evert {

/// What PETSc calls: no exception may pass through its C frames, so failures end here as its error codes.
struct EquilibriumCallbacks {
  template <class Work>
  static PetscErrorCode guarded(Work&& work) {
    try {
      work();
      return 0;
    } catch (const std::exception&) {
      return PETSC_ERR_LIB;
    }
  }
  static EquilibriumSolver& self(void* context) { return *static_cast<EquilibriumSolver*>(context); }

  static PetscErrorCode residual(SNES /*snes*/, Vec x, Vec out, void* context) {
    return guarded([&] { self(context).residual(x, out); });
  }
  static PetscErrorCode objective(SNES /*snes*/, Vec x, PetscReal* value, void* context) {
    return guarded([&] { *value = self(context).energy_change(x); });
  }
  static PetscErrorCode jacobian(SNES /*snes*/, Vec x, Mat /*mat*/, Mat /*of_pc*/, void* context) {
    return guarded([&] { self(context).jacobian(x); });
  }
  static PetscErrorCode update(SNES snes, PetscInt /*iteration*/) {
    void* context = nullptr;
    if (const auto code = SNESGetApplicationContext(snes, static_cast<void*>(&context)); code != 0)
      return code;
    return guarded([&] { self(context).begin_iteration(); });
  }
};

namespace {

// Of the step that a free node would make; measured in docs/design/quasistatic.md.
constexpr double inertia_share = 1;
// What makes the matrices of free bodies regular, of their size: no more than the rounding of rigid motions.
constexpr double singular = 1e-13;
// After a failure the full tangent is tried again when the residual has fallen to this share.
constexpr double full_again = 0.01;

double sum_over_ranks(MPI_Comm comm, double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, comm);
  return value;
}

double norm_of(Vec vec, NormType type = NORM_2) {
  PetscReal norm = 0;
  check(VecNorm(vec, type, &norm));
  return norm;
}

void zero_held(std::span<const NodeConstraint> held, Vec vec) {
  const VecView view(vec);
  project(held, view.values());
}

/// Root of the mean square distance from the centre of mass at rest [m].
double gyration_radius(const System& system, double total_mass) {
  const auto mass = system.masses();
  std::array<double, 4> sums{};
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto& x = system.mesh.rest_positions[i];
    for (std::size_t k = 0; k < 3; ++k) sums[k] += mass[i] * x[k];
    sums[3] += mass[i] * dot(x, x);
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, system.mesh.comm);
  const Vec3d center = (1 / total_mass) * Vec3d{sums[0], sums[1], sums[2]};
  return std::sqrt(std::max(sums[3] / total_mass - dot(center, center), 0.0));
}

}  // namespace

EquilibriumSolver::EquilibriumSolver(const System& system, TangentChoice choice)
    : system_(system),
      choice_(choice),
      stiffness_(system.mesh, system.elastic, quasistatic_matrix_type(system.mesh.comm).c_str()),
      trial_(system.mesh),
      force_(system.mesh),
      load_(system.mesh),
      pull_(system.mesh) {
  const auto comm = system.mesh.comm;
  double mass = 0, squares = 0;
  for (const double m : system.masses()) {
    mass += m;
    squares += m * m;
  }
  total_mass_ = sum_over_ranks(comm, mass);
  mass_norm_ = std::sqrt(sum_over_ranks(comm, squares));
  length_ = gyration_radius(system, total_mass_);
  check(MatCreateVecs(stiffness_.mat(), x_.out(), nullptr));
  for (auto* vec : {&function_, &base_, &base_residual_, &work_, &slope_, &right_, &change_})
    check(VecDuplicate(x_.get(), vec->out()));

  const auto type = quasistatic_matrix_type(comm);
  snes_ = quasistatic_snes(comm, type);
  const auto snes = snes_.get();
  check(SNESSetApplicationContext(snes, this));
  check(SNESSetFunction(snes, function_.get(), EquilibriumCallbacks::residual, this));
  check(SNESSetObjective(snes, EquilibriumCallbacks::objective, this));
  check(SNESSetJacobian(snes, stiffness_.mat(), stiffness_.mat(), EquilibriumCallbacks::jacobian, this));
  check(SNESSetUpdate(snes, EquilibriumCallbacks::update));
  read_quasistatic_options(snes, type);
  check(SNESGetTolerances(snes, &atol_, &rtol_, nullptr, &most_iterations_, nullptr));

  std::copy(system.x.owned().begin(), system.x.owned().end(), trial_.owned().begin());
  stiffness_.assemble(trial_, TangentForm::projected, 1);
  KSP ksp = nullptr;
  check(SNESGetKSP(snes, &ksp));
  check(KSPSetOperators(ksp, stiffness_.mat(), stiffness_.mat()));
  try_set_up(ksp);
}

void EquilibriumSolver::print_options(MPI_Comm comm) {
  const auto type = quasistatic_matrix_type(comm);
  const auto snes = quasistatic_snes(comm, type);
  read_quasistatic_options(snes.get(), type);
}

// --- what SNES asks for

void EquilibriumSolver::set_trial(Vec x) {
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(x, &values));
  auto trial = trial_.owned();
  std::copy(values, values + trial.size(), trial.begin());
  check(VecRestoreArrayRead(x, &values));
  trial_.touched();
}

/// −P (f(x) + loads): the gradient of the energy.
void EquilibriumSolver::residual(Vec x, Vec out) {
  set_trial(x);
  system_.elastic.update(trial_, force_);
  const auto load = load_.owned();
  const auto force = force_.owned();
  const VecView result(out);
  for (std::size_t i = 0; i < force.size(); ++i) result.values()[i] = -(force[i] + load[i]);
  project(held_, result.values());
}

/// Energy at `x` less that where the iteration began: what the line search looks at. Where the difference
/// drowns in the rounding of the energies it is taken from the forces at both ends (the trapezoidal rule),
/// which is exact to third order in a step that is small by then.
double EquilibriumSolver::energy_change(Vec x) {
  constexpr double resolved = 1e-8;
  set_trial(x);
  system_.elastic.halo().begin_update(trial_);
  system_.elastic.halo().end_update(trial_);
  check(VecWAXPY(work_.get(), -1, base_.get(), x));
  std::array<double, 2> sums{system_.elastic.energy(trial_), 0};
  {
    const VecView way(work_.get());
    for (std::size_t i = 0; i < way.values().size(); ++i) sums[1] += load_.owned()[i] * way.values()[i];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, system_.mesh.comm);
  const double change = sums[0] - base_energy_ - sums[1];
  if (!std::isfinite(change)) return std::numeric_limits<float>::max();  // PETSc raises an error at infinity
  if (std::abs(change) > resolved * (std::abs(base_energy_) + std::abs(sums[1]))) return change;
  residual(x, slope_.get());
  check(VecAXPY(slope_.get(), 1, base_residual_.get()));
  PetscScalar product = 0;
  check(VecDot(slope_.get(), work_.get(), &product));
  return product / 2;
}

void EquilibriumSolver::begin_iteration() {
  Vec x = nullptr, residual = nullptr;
  check(SNESGetSolution(snes_.get(), &x));
  check(SNESGetFunction(snes_.get(), &residual, nullptr, nullptr));
  check(VecCopy(x, base_.get()));
  check(VecCopy(residual, base_residual_.get()));
  set_trial(x);
  system_.elastic.halo().begin_update(trial_);
  system_.elastic.halo().end_update(trial_);
  base_energy_ = sum_over_ranks(system_.mesh.comm, system_.elastic.energy(trial_));
}

/// Near rest the projected tangent would spoil the quadratic convergence wherever something is compressed;
/// far from it the full one need not descend.
TangentForm EquilibriumSolver::next_form() {
  if (choice_ == TangentChoice::full) return TangentForm::full;
  if (choice_ == TangentChoice::projected) return TangentForm::projected;
  PetscInt iteration = 0;
  PetscReal norm = 0, lambda = 0;
  SNESLineSearch search = nullptr;
  check(SNESGetIterationNumber(snes_.get(), &iteration));
  check(SNESGetFunctionNorm(snes_.get(), &norm));
  check(SNESGetLineSearch(snes_.get(), &search));
  check(SNESLineSearchGetLambda(search, &lambda));
  const bool near = iteration > 0 && lambda == 1 && norm <= last_norm_ / 2 && norm < full_below_;
  last_norm_ = norm;
  full_used_ = full_used_ || near;
  return near ? TangentForm::full : TangentForm::projected;
}

void EquilibriumSolver::jacobian(Vec x) {
  const double sigma = inertia(base_residual_.get());
  set_trial(x);
  stiffness_.assemble(trial_, next_form(), sigma);
}

/// σ: no node that moves freely goes much further than the size of the bodies in one Newton step. It vanishes
/// with the residual, and so does what it takes from the rate of convergence.
double EquilibriumSolver::inertia(Vec residual) const {
  const auto mass = system_.masses();
  const VecView r(residual);
  double sum = 0;
  for (std::size_t i = 0; i < r.values().size(); ++i) sum += r.values()[i] * r.values()[i] / mass[i / 3];
  const double acceleration = std::sqrt(sum_over_ranks(system_.mesh.comm, sum) / total_mass_);
  return std::max(inertia_share * acceleration / length_, least_inertia_);
}

// --- one equilibrium

EquilibriumSolver::Outcome EquilibriumSolver::solve(NodeField& x, std::span<const NodeConstraint> held,
                                                    const NodeField& withheld, double load, double t) {
  const PhaseScope scope(Phase::static_solve);
  held_ = held;
  std::fill(load_.owned().begin(), load_.owned().end(), 0.0);
  system_.add_loads(t, load_);
  for (std::size_t i = 0; i < load_.owned().size(); ++i) load_.owned()[i] -= withheld.owned()[i];
  {
    const VecView start(x_.get());
    std::copy(x.owned().begin(), x.owned().end(), start.values().begin());
  }
  Outcome outcome;
  const double rounding = predict();
  full_below_ = std::numeric_limits<double>::infinity();
  residual(x_.get(), base_residual_.get());
  const double target = std::max({atol_, rounding, rtol_ * load, rtol_ * norm_of(base_residual_.get())});
  auto reason = iterate(target, outcome);
  while (reason < 0 && full_used_ &&
         outcome.newton_iterations < most_iterations_) {  // too early for the full one
    PetscReal norm = 0;
    check(SNESGetFunctionNorm(snes_.get(), &norm));
    full_below_ = full_again * norm;
    reason = iterate(target, outcome);
  }
  outcome.converged = reason > 0;
  outcome.reason = SNESConvergedReasons[reason];
  const VecView end(x_.get());
  std::copy(end.values().begin(), end.values().end(), x.owned().begin());
  x.touched();
  return outcome;
}

/// Moves held components by their ways and the others along, as far as the tangent knows. Returns the
/// rounding that any residual has.
double EquilibriumSolver::predict() {
  residual(x_.get(), work_.get());
  stiffness_.hold(held_);
  set_trial(x_.get());
  stiffness_.assemble(trial_, TangentForm::projected, inertia(work_.get()), pull_);
  check(MatGetDiagonal(stiffness_.mat(), right_.get()));
  const double stiffness = norm_of(right_.get());
  least_inertia_ = singular * stiffness / mass_norm_;
  const double rounding =
      4 * std::numeric_limits<double>::epsilon() * stiffness * norm_of(x_.get(), NORM_INFINITY);

  double furthest = 0;
  for (const auto& c : held_) furthest = std::max(furthest, norm(c.prescribed));
  MPI_Allreduce(MPI_IN_PLACE, &furthest, 1, MPI_DOUBLE, MPI_MAX, system_.mesh.comm);
  if (furthest == 0) return rounding;
  KSP ksp = nullptr;
  check(VecWAXPY(right_.get(), 1, work_.get(), pull_.vec()));
  check(SNESGetKSP(snes_.get(), &ksp));
  check(KSPSetOperators(ksp, stiffness_.mat(), stiffness_.mat()));
  check(KSPSolve(ksp, right_.get(), change_.get()));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp, &reason));
  if (reason > 0) {
    zero_held(held_, change_.get());
    check(VecAXPY(x_.get(), -1, change_.get()));
  }
  const VecView moved(x_.get());
  for (const auto& c : held_)
    set_node_value(moved.values(), c.node, node_value(moved.values(), c.node) + c.prescribed);
  return rounding;
}

/// Newton's method from x_ to a residual of `target`, with the iterations that are left.
SNESConvergedReason EquilibriumSolver::iterate(double target, Outcome& outcome) {
  check(SNESSetTolerances(snes_.get(), target, 0, PETSC_DEFAULT, most_iterations_ - outcome.newton_iterations,
                          PETSC_DEFAULT));
  full_used_ = false;
  last_norm_ = 0;
  check(SNESSolve(snes_.get(), nullptr, x_.get()));
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt newton = 0, linear = 0;
  check(SNESGetConvergedReason(snes_.get(), &reason));
  check(SNESGetIterationNumber(snes_.get(), &newton));
  check(SNESGetLinearSolveIterations(snes_.get(), &linear));
  outcome.newton_iterations += static_cast<int>(newton);
  outcome.linear_iterations += static_cast<int>(linear);
  return reason;
}

}  // namespace evert
