#include "euler_step.hpp"

#include "evert/core/log.hpp"
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/explicit_damping.hpp"
#include "evert/integrators/held_nodes.hpp"

#include "set_vec.hpp"

namespace evert {

void euler_kick(System& system, DampingSolver& solver, NodeField& force, Vec right, double dt) {
  const auto mass = system.masses();
  const auto v = system.v.owned();
  system.begin_projection(dt);
  damped_force(system, system.v, force);
  account_for_mass_damping(system, v, dt);
  account_for_gravity(system, dt);
  const auto total = force.owned();
  set_vec(right, [&](std::size_t i, double) { return mass[i / 3] * v[i] + dt * total[i]; });
  const auto held = system.prescribed.at(system.time + dt);
  system.prepare_solve(dt);
  solver.solve(0, right, system.v, held);
  if (!system.prescribed.empty()) system.impulses.constraint += exerted(held, solver.reaction());
}

StepReport euler_drift(System& system, const NodeField& velocity, double dt) {
  auto x = system.x.owned();
  const auto travelled = velocity.owned();
  {
    const PhaseScope scope(Phase::vector_update, 2.0 * static_cast<double>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * travelled[i];
  }
  {
    const PhaseScope scope(Phase::contact);
    const double end = system.time + dt;
    system.collisions.resolve(x, system.v.owned(), travelled, system.prescribed.at(end), {end, dt});
    impose(system.prescribed.at(end), system.v.owned());
  }
  system.x.touched();
  system.v.touched();
  const int projected = system.project(system.prescribed.at(system.time + dt), dt);
  account_for_obstacles(system, dt);
  system.time += dt;
  system.update_forces(system.time);
  return {.dt = dt,
          .contacts = system.collisions.contacts(),
          .projection_iterations = projected,
          .notes = system.collisions.take_notes()};
}

}  // namespace evert
