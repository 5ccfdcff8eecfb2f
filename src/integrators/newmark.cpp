#include "evert/integrators/newmark.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include <algorithm>
#include <array>
#include <functional>

namespace evert {
namespace {

// Two passes settle a body that slides. Among many contacts there are always some at the edge of sticking
// that change in every pass: what they exert is left to the next step once it is this share of all friction.
constexpr int most_friction_passes = 5;
constexpr double friction_tolerance = 1e-3;

/// Every owned component of `vec` becomes value(index, component).
template <class Value>
void set_vec(Vec vec, Value&& value) {
  PetscScalar* values = nullptr;
  PetscInt size = 0;
  check(VecGetLocalSize(vec, &size));
  check(VecGetArray(vec, &values));
  {
    const PhaseScope scope(Phase::vector_update, 3.0 * size);
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) values[i] = value(i, values[i]);
  }
  check(VecRestoreArray(vec, &values));
}

}  // namespace

Newmark::Newmark(const System& system) : solver_(system.mesh, system.elastic), predicted_(system.mesh) {
  check(VecCreateMPI(system.mesh.comm, 3 * system.mesh.owned_nodes, PETSC_DETERMINE, right_.out()));
  constraints_.reserve(system.masses().size());
  if (!system.rigid.empty()) coupling_.emplace(system);
}

StepReport Newmark::advance(System& system, double dt) {
  StepReport report{.dt = dt};
  report.cg_iterations = predict(system, dt);
  const auto held = collide(system, dt);
  if (!held.colliding) account_for_mass_damping(system, dt / 2);
  report.cg_iterations += correct(system, dt, held.colliding);
  if (held.colliding || held.prescribed) report.cg_iterations += rub(system);
  if (coupling_) coupling_->finish(system);
  account_for_obstacles(system, dt);
  account_for_mass_damping(system, implicit_);
  remember_change(system, system.v.owned(), predicted_.owned());
  report.contacts = system.collisions.contacts();
  report.notes = system.collisions.take_notes();
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
  const int iterations = solver_.solve(dt / 2, right_.get(), predicted_,
                                       system.prescribed.at(system.time + dt / 2), system.v_change.vec());
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

/// 3. collisions turn x̃ into xⁿ⁺¹ and vⁿ into ṽⁿ. Returns what holds nodes of any rank now.
Newmark::Held Newmark::collide(System& system, double dt) {
  const PhaseScope scope(Phase::contact);
  constraints_.clear();
  if (!system.collisions.any_obstacles() && system.prescribed.empty()) return {};
  prescribed_ = system.prescribed.at(system.time + dt);
  if (coupling_) system.rigid.advance({system.time + dt, dt}, system.gravity);
  system.collisions.resolve(system.x.owned(), system.v.owned(), predicted_.owned(), prescribed_,
                            {system.time + dt, dt});
  system.x.touched();
  system.v.touched();
  join(prescribed_, system.collisions.constraints(), constraints_);
  std::array<int, 2> flags{system.collisions.contacts() > 0 ? 1 : 0, prescribed_.empty() ? 0 : 1};
  MPI_Allreduce(MPI_IN_PLACE, flags.data(), 2, MPI_INT, MPI_MAX, system.mesh.comm);
  return {flags[0] != 0, flags[1] != 0};
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
  system.update_forces(system.time + dt);
  set_vec(right_.get(), [&](std::size_t i, double sum) { return sum + dt / 2 * f[i]; });
  for (const double m : system.mass_row_sums()) system.impulses.gravity += dt * m * system.gravity;
  follow_forces(system);
  return solver_.solve(implicit_, right_.get(), system.v, constraints_, system.v_change.vec());
}

/// Collective.
bool obeys_coulomb(const System& system, std::span<const double> reaction) {
  const auto error = system.collisions.friction_error(system.v.owned(), reaction);
  std::array<double, 2> sums{error.excess, error.allowed};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, system.mesh.comm);
  return sums[0] <= friction_tolerance * sums[1];
}

/// The solve held whatever friction may hold. Nodes that pull harder than Coulomb allows slide, and those
/// that friction would turn round stick again: solved once more, with the impulses of sliding friction on the
/// right, until friction is Coulomb's. Then the account of what the constraints exerted.
int Newmark::rub(System& system) {
  auto& collisions = system.collisions;
  int iterations = couple(system);
  auto reaction = solver_.reaction();
  for (int pass = 0; pass < most_friction_passes; ++pass) {
    if (obeys_coulomb(system, reaction)) break;
    collisions.slide(system.v.owned(), reaction);
    join(prescribed_, collisions.constraints(), constraints_);
    iterations += solver_.refine(system.v, constraints_);
    iterations += couple(system);
    reaction = solver_.reaction();
  }
  collisions.stop_reversed(system.v.owned());
  impose(prescribed_, system.v.owned());
  system.v.touched();
  collisions.share_impulses(reaction, prescribed_, constraints_);
  for (const auto& c : prescribed_) {
    const auto r = node_value(reaction, c.node);
    system.impulses.constraint += r - c.free * r;
  }
  return iterations;
}

/// Takes the rigid bodies that have a mass to the velocities that go with what the nodes do, and the nodes to
/// these.
int Newmark::couple(System& system) {
  if (!coupling_) return 0;
  int iterations = 0;
  system.collisions.share_impulses(solver_.reaction(), prescribed_, constraints_);
  const auto follow = [&](std::span<const RigidState> before) {
    for (std::size_t b = 0; b < before.size(); ++b)
      system.collisions.follow(system.rigid.bodies()[b], before[b]);
    join(prescribed_, system.collisions.constraints(), constraints_);
    iterations += solver_.refine(system.v, constraints_);
    system.collisions.share_impulses(solver_.reaction(), prescribed_, constraints_);
  };
  coupling_->solve(system, std::cref(follow));  // by reference: a function of its own would be allocated
  return iterations;
}

/// What each obstacle gave, to nodes and to bodies, and what came from those that have no momentum of their
/// own. Every rank has all bodies: one of them counts what they got.
void Newmark::account_for_obstacles(System& system, double dt) {
  const bool counts_bodies = rank_of(system.mesh.comm) == 0;
  for (std::size_t o = 0; o < system.obstacle_impulses.size(); ++o) {
    auto given = system.collisions.impulse_of(o);
    if (counts_bodies && !system.rigid.empty()) {
      given.linear += system.rigid.impulse_of(o).first;
      given.angular += system.rigid.impulse_of(o).second;
    }
    system.obstacle_impulses[o].linear += given.linear;
    system.obstacle_impulses[o].angular += given.angular;
    if (system.collisions.obstacles()[o]->body() == nullptr) system.impulses.contact += given.linear;
  }
  if (!counts_bodies) return;
  for (const auto number : system.rigid.bodies())
    system.impulses.gravity += dt * system.rigid.body(number).mass().mass * system.gravity;
}

/// What mass-proportional damping takes off the momentum in a time `dt` at the present velocities.
void Newmark::account_for_mass_damping(System& system, double dt) {
  const auto damping = system.elastic.mass_damping();
  for (std::size_t node = 0; node < damping.size(); ++node)
    system.impulses.damping -=
        dt * damping[node] * node_value(system.v.owned(), static_cast<std::ptrdiff_t>(node));
}

/// C(x) and its diagonal are those of the last force update, whoever asked for it.
void Newmark::follow_forces(const System& system) {
  if (forces_seen_ != system.force_updates) solver_.invalidate();
  forces_seen_ = system.force_updates;
}

}  // namespace evert
