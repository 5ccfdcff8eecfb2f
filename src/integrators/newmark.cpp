#include "evert/integrators/newmark.hpp"

#include "evert/core/log.hpp"

#include "set_vec.hpp"
#include <algorithm>

namespace evert {

Newmark::Newmark(const System& system)
    : solver_(system.mesh, system.elastic, system.implicit_strains), held_(system), predicted_(system.mesh) {
  check(VecCreateMPI(system.mesh.comm, 3 * system.mesh.owned_nodes, PETSC_DETERMINE, right_.out()));
}

double Newmark::stable_step(const System& system) {
  // At its limit a stiffly damped mode changes sign in every step; at half of it, it decays.
  const auto bound = system.elastic.stable_step(system.x);
  return std::max(bound.undamped, bound.damped / 2);
}

StepReport Newmark::advance(System& system, double dt) {
  StepReport report{.dt = dt};
  system.begin_projection(dt);
  report.cg_iterations = predict(system, dt);
  const auto held = held_.collide(system, predicted_, dt);  // 3.
  report.projection_iterations = system.project(held_.constraints(), dt);
  if (!held.colliding) account_for_mass_damping(system, system.v.owned(), dt / 2);
  report.cg_iterations += correct(system, dt, held.colliding);
  if (held.any()) report.cg_iterations += held_.rub(system, solver_);
  held_.finish(system, report);
  account_for_mass_damping(system, system.v.owned(), implicit_);
  remember_change(system, system.v.owned(), predicted_.owned());
  system.time += dt;
  return report;
}

/// right_ = M v + Δt/2 f, of the system as it is
void Newmark::take_momentum_and_half_impulse(const System& system, double dt) {
  const auto f = system.f.owned();
  if (system.elastic.consistent_mass() != nullptr) {
    set_vec(right_.get(), [&](std::size_t i, double) { return dt / 2 * f[i]; });
    solver_.add_momentum(system.v.vec(), right_.get());
    return;
  }
  const auto mass = system.masses();
  const auto v = system.v.owned();
  set_vec(right_.get(), [&](std::size_t i, double) { return mass[i / 3] * v[i] + dt / 2 * f[i]; });
}

/// 1. (M + Δt/2 C(xⁿ)) ṽ = M vⁿ + Δt/2 f(xⁿ),  2. x̃ = xⁿ + Δt ṽ
int Newmark::predict(System& system, double dt) {
  const auto v = system.v.owned();
  take_momentum_and_half_impulse(system, dt);
  std::copy(v.begin(), v.end(), predicted_.owned().begin());
  predicted_.touched();
  follow_forces(system);
  system.prepare_solve(dt);
  const int iterations =
      solver_.solve(dt / 2, right_.get(), predicted_, held_.hold_on_the_way(system, dt, right_.get()),
                    system.v_change.vec());
  remember_change(system, predicted_.owned(), v);
  const PhaseScope scope(Phase::vector_update, 2.0 * static_cast<double>(v.size()));
  auto x = system.x.owned();
  const auto predicted = predicted_.owned();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * predicted[i];
  system.x.touched();
  return iterations;
}

/// v_change = after − before: accelerations hardly change from one half of a step to the next.
void Newmark::remember_change(System& system, std::span<const double> after,
                              std::span<const double> before) const {
  if (!solver_.iterates()) return;
  set_vec(system.v_change.vec(), [&](std::size_t i, double) { return after[i] - before[i]; });
}

/// 4. (M + Δt/2 C(xⁿ⁺¹)) vⁿ⁺¹ = M ṽⁿ + Δt/2 [f(xⁿ) − C(xⁿ) ṽⁿ + f(xⁿ⁺¹)]
///
/// In steps with contacts the damping is taken at the end of the step alone, (M + Δt C(xⁿ⁺¹)) vⁿ⁺¹: the
/// trapezoidal rule lets stiffly damped modes alternate in sign, and the reactions that friction is made of
/// with them.
int Newmark::correct(System& system, double dt, bool colliding) {
  const auto f = system.f.owned();
  implicit_ = colliding ? dt : dt / 2;
  take_momentum_and_half_impulse(system, dt);
  if (!colliding)
    solver_.add_damping(system.v.vec(), right_.get(), -dt / 2);  // with C(xⁿ), before it changes
  solver_.carry_over(right_.get(), system.v);
  system.update_forces(system.time + dt);
  set_vec(right_.get(), [&](std::size_t i, double sum) { return sum + dt / 2 * f[i]; });
  account_for_gravity(system, dt);
  follow_forces(system);
  system.prepare_solve(dt);
  return solver_.solve(implicit_, right_.get(), system.v, held_.constraints(), system.v_change.vec());
}

/// C(x) and its diagonal are those of the last force update, whoever asked for it.
void Newmark::follow_forces(const System& system) {
  if (forces_seen_ != system.force_updates) solver_.invalidate();
  forces_seen_ = system.force_updates;
}

}  // namespace evert
