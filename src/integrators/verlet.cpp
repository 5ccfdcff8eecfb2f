#include "evert/integrators/verlet.hpp"

#include "evert/core/log.hpp"
#include "evert/integrators/explicit_damping.hpp"

#include "set_vec.hpp"
#include <algorithm>

namespace evert {

Verlet::Verlet(const System& system)
    : solver_(DampingSolver::without_damping(system.mesh, system.elastic, system.implicit_strains)),
      held_(system),
      middle_(system.mesh),
      force_(system.mesh) {
  check(VecCreateMPI(system.mesh.comm, 3 * system.mesh.owned_nodes, PETSC_DETERMINE, right_.out()));
}

double Verlet::stable_step(const System& system) { return explicitly_damped_step(system); }

StepReport Verlet::advance(System& system, double dt) {
  StepReport report{.dt = dt};
  system.begin_projection(dt);
  kick_and_drift(system, dt);
  const auto held = held_.collide(system, middle_, dt);
  report.projection_iterations = system.project(held_.constraints(), dt);
  kick(system, dt);
  if (held.any()) held_.rub(system, solver_);
  held_.finish(system, report);
  account_for_gravity(system, dt);
  system.time += dt;
  return report;
}

/// 1. M v½ = M vⁿ + Δt/2 (f(xⁿ) − C(xⁿ) vⁿ),  2. x̃ = xⁿ + Δt v½
void Verlet::kick_and_drift(System& system, double dt) {
  const auto mass = system.masses();
  const auto v = system.v.owned();
  damped_force(system, system.v, force_);
  account_for_mass_damping(system, v, dt / 2);
  const auto force = force_.owned();
  set_vec(right_.get(), [&](std::size_t i, double) { return mass[i / 3] * v[i] + dt / 2 * force[i]; });
  std::copy(v.begin(), v.end(), middle_.owned().begin());
  system.prepare_solve(dt);
  solver_.solve(0, right_.get(), middle_, system.prescribed.at(system.time + dt / 2));
  const PhaseScope scope(Phase::vector_update, 2.0 * static_cast<double>(v.size()));
  auto x = system.x.owned();
  const auto middle = middle_.owned();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * middle[i];
  system.x.touched();
}

/// 4. M vⁿ⁺¹ = M ṽⁿ + Δt/2 [f(xⁿ) − C(xⁿ) vⁿ + f(xⁿ⁺¹) − C(xⁿ⁺¹) v*], where v* = 2 v½ − ṽⁿ is vⁿ⁺¹ to second
/// order; held nodes have the velocity that they are held to.
void Verlet::kick(System& system, double dt) {
  const auto mass = system.masses();
  const auto v = system.v.owned();
  const auto force = force_.owned();
  set_vec(right_.get(), [&](std::size_t i, double) { return mass[i / 3] * v[i] + dt / 2 * force[i]; });
  auto expected = middle_.owned();
  for (std::size_t i = 0; i < v.size(); ++i) expected[i] = 2 * expected[i] - v[i];
  impose(held_.constraints(), expected);
  middle_.touched();
  account_for_mass_damping(system, expected, dt / 2);
  solver_.carry_over(right_.get(), system.v);
  system.update_forces(system.time + dt);
  damped_force(system, middle_, force_);
  set_vec(right_.get(), [&](std::size_t i, double sum) { return sum + dt / 2 * force[i]; });
  system.prepare_solve(dt);
  solver_.solve(0, right_.get(), system.v, held_.constraints());
}

}  // namespace evert
