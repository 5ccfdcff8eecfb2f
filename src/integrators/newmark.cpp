#include "evert/integrators/newmark.hpp"

#include <algorithm>

#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

namespace evert {
namespace {

/// Every owned component of `vec` becomes value(index, component).
template <class Value>
void set_vec(Vec vec, Value&& value) {
  PetscScalar* data = nullptr;
  PetscInt size = 0;
  check(VecGetLocalSize(vec, &size));
  check(VecGetArray(vec, &data));
  for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) data[i] = value(i, data[i]);
  check(VecRestoreArray(vec, &data));
}

/// True when any rank says so.
bool anywhere(MPI_Comm comm, bool here) {
  int flag = here ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, comm);
  return flag != 0;
}

}  // namespace

Newmark::Newmark(const System& system) : solver_(system.mesh, system.elastic), predicted_(system.mesh) {
  check(VecCreateMPI(system.mesh.comm, 3 * system.mesh.owned_nodes, PETSC_DETERMINE, right_.out()));
  constraints_.reserve(system.masses().size());
}

StepReport Newmark::advance(System& system, double dt) {
  StepReport report{dt, 0, 0};
  report.cg_iterations = predict(system, dt);
  const bool constrained = collide(system, dt);
  report.cg_iterations += correct(system, dt);
  if (constrained) rub(system, dt);
  report.contacts = system.collisions.contacts();
  system.time += dt;
  return report;
}

/// 1. (M + Δt/2 C(xⁿ)) ṽ = M vⁿ + Δt/2 f(xⁿ),  2. x̃ = xⁿ + Δt ṽ
int Newmark::predict(System& system, double dt) {
  const auto mass = system.masses();
  const auto v = system.v.owned();
  const auto f = system.f.owned();
  {
    const PhaseScope scope(Phase::vector_update, 4.0 * static_cast<double>(v.size()));
    set_vec(right_.get(), [&](std::size_t i, double) { return mass[i / 3] * v[i] + dt / 2 * f[i]; });
    std::copy(v.begin(), v.end(), predicted_.owned().begin());
    predicted_.touched();
  }
  follow_forces(system);
  const int iterations =
      solver_.solve(dt / 2, right_.get(), predicted_, system.prescribed.at(system.time + dt / 2));
  const PhaseScope scope(Phase::vector_update, 2.0 * static_cast<double>(v.size()));
  auto x = system.x.owned();
  const auto predicted = predicted_.owned();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * predicted[i];
  system.x.touched();
  return iterations;
}

/// 3. collisions turn x̃ into xⁿ⁺¹ and vⁿ into ṽⁿ. Returns whether any node of any rank is constrained now.
bool Newmark::collide(System& system, double dt) {
  const PhaseScope scope(Phase::contact);
  constraints_.clear();
  if (!system.collisions.any_obstacles() && system.prescribed.empty()) return false;
  prescribed_ = system.prescribed.at(system.time + dt);
  system.collisions.resolve(system.x.owned(), system.v.owned(), predicted_.owned(), prescribed_,
                            {system.time + dt, dt});
  system.x.touched();
  system.v.touched();
  join(prescribed_, system.collisions.constraints(), constraints_);
  return anywhere(system.mesh.comm, !constraints_.empty());
}

/// 4. (M + Δt/2 C(xⁿ⁺¹)) vⁿ⁺¹ = M ṽⁿ + Δt/2 [f(xⁿ) − C(xⁿ) ṽⁿ + f(xⁿ⁺¹)]
int Newmark::correct(System& system, double dt) {
  const auto mass = system.masses();
  const auto v = system.v.owned();
  const auto f = system.f.owned();
  set_vec(right_.get(), [&](std::size_t i, double) { return mass[i / 3] * v[i] + dt / 2 * f[i]; });
  solver_.add_damping(system.v.vec(), right_.get(), -dt / 2);  // with C(xⁿ), before it changes
  system.update_forces();
  set_vec(right_.get(), [&](std::size_t i, double sum) { return sum + dt / 2 * f[i]; });
  for (const double m : mass) system.impulses.gravity += dt * m * system.gravity;
  follow_forces(system);
  return solver_.solve(dt / 2, right_.get(), system.v, constraints_);
}

/// Friction of what the constraints exerted in the solve, and the account of it.
void Newmark::rub(System& system, double dt) {
  const auto reaction = solver_.reaction(dt / 2);
  const PhaseScope scope(Phase::contact);
  system.collisions.apply_friction(system.v.owned(), reaction);
  impose(prescribed_, system.v.owned());
  system.v.touched();
  const auto exerted = [&](std::span<const NodeConstraint> constraints) {
    Vec3d sum{};
    for (const auto& c : constraints) {
      const auto r = node_value(reaction, c.node);
      sum += r - c.free * r;
    }
    return sum;
  };
  const auto by_prescription = exerted(prescribed_);
  system.impulses.constraint += by_prescription;
  system.impulses.contact += exerted(constraints_) - by_prescription + system.collisions.impulse();
}

/// C(x) and its diagonal are those of the last force update, whoever asked for it.
void Newmark::follow_forces(const System& system) {
  if (forces_seen_ != system.force_updates) solver_.invalidate();
  forces_seen_ = system.force_updates;
}

}  // namespace evert
