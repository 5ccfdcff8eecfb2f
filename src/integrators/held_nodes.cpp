#include "evert/integrators/held_nodes.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include <array>
#include <functional>

namespace evert {
namespace {

// Two passes settle a body that slides. Among many contacts there are always some at the edge of sticking
// that change in every pass: what they exert is left to the next step once it is this share of all friction.
constexpr int most_friction_passes = 5;
constexpr double friction_tolerance = 1e-3;

/// Collective.
bool obeys_coulomb(const System& system, std::span<const double> reaction) {
  const auto error = system.collisions.friction_error(system.v.owned(), reaction);
  std::array<double, 2> sums{error.excess, error.allowed};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, system.mesh.comm);
  return sums[0] <= friction_tolerance * sums[1];
}

}  // namespace

HeldNodes::HeldNodes(const System& system) {
  constraints_.reserve(system.masses().size());
  if (!system.rigid.empty()) coupling_.emplace(system);
}

std::span<const NodeConstraint> HeldNodes::hold_on_the_way(System& system, double dt, Vec right) {
  const PhaseScope scope(Phase::contact);
  const auto prescribed = system.prescribed.at(system.time + dt / 2);
  if (!system.collisions.any_obstacles()) return prescribed;
  const auto& standing = system.collisions.find_standing(system.x.owned(), system.v.owned(), system.f.owned(),
                                                         prescribed, {system.time + dt, dt});
  PetscScalar* impulses = nullptr;
  check(VecGetArray(right, &impulses));
  for (std::size_t i = 0; i < standing.constraints().size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      impulses[3 * standing.constraints()[i].node + static_cast<LocalIndex>(k)] += standing.friction()[i][k];
  check(VecRestoreArray(right, &impulses));
  join(prescribed, standing.constraints(), constraints_);
  return constraints_;
}

HeldNodes::Kinds HeldNodes::collide(System& system, const NodeField& predicted, double dt) {
  const PhaseScope scope(Phase::contact);
  constraints_.clear();
  prescribed_ = {};
  if (!system.collisions.any_obstacles() && system.prescribed.empty()) return {};
  prescribed_ = system.prescribed.at(system.time + dt);
  if (coupling_) system.rigid.advance({system.time + dt, dt}, system.gravity);
  system.collisions.resolve(system.x.owned(), system.v.owned(), predicted.owned(), prescribed_,
                            {system.time + dt, dt});
  system.x.touched();
  system.v.touched();
  join(prescribed_, system.collisions.constraints(), constraints_);
  std::array<int, 2> flags{system.collisions.contacts() > 0 ? 1 : 0, prescribed_.empty() ? 0 : 1};
  MPI_Allreduce(MPI_IN_PLACE, flags.data(), 2, MPI_INT, MPI_MAX, system.mesh.comm);
  return {flags[0] != 0, flags[1] != 0};
}

/// The solve held whatever friction may hold. Nodes that pull harder than Coulomb allows slide, and those
/// that friction would turn round stick again: solved once more, with the impulses of sliding friction on the
/// right, until friction is Coulomb's. Then the account of what the constraints exerted.
int HeldNodes::rub(System& system, DampingSolver& solver) {
  auto& collisions = system.collisions;
  int iterations = couple(system, solver);
  auto reaction = solver.reaction();
  for (int pass = 0; pass < most_friction_passes; ++pass) {
    if (obeys_coulomb(system, reaction)) break;
    collisions.slide(system.v.owned(), reaction);
    join(prescribed_, collisions.constraints(), constraints_);
    iterations += solver.refine(system.v, constraints_);
    iterations += couple(system, solver);
    reaction = solver.reaction();
  }
  collisions.stop_reversed(system.v.owned());
  impose(prescribed_, system.v.owned());
  system.v.touched();
  collisions.share_impulses(reaction, prescribed_, constraints_);
  system.impulses.constraint += exerted(prescribed_, reaction);
  take_out_residual(system, constraints_, reaction);
  return iterations;
}

/// The solver leaves a residual r of the equations, and with it momentum that nothing has exerted. The
/// velocities that go with the damping forces at hand, v − M⁻¹ r, leave none: what obstacles gave is then
/// what the nodes got, to rounding, at any tolerance of the solver.
void HeldNodes::take_out_residual(System& system, std::span<const NodeConstraint> all,
                                  std::span<const double> reaction) {
  if (system.elastic.consistent_mass() != nullptr) return;  // M⁻¹ would be a solve of its own
  const auto mass = system.masses();
  const auto v = system.v.owned();
  auto held = all.begin();
  for (std::size_t node = 0; node < mass.size(); ++node) {
    const auto index = static_cast<LocalIndex>(node);
    auto residual = node_value(reaction, index);
    if (held != all.end() && held->node == index) residual = (held++)->free * residual;
    set_node_value(v, index, node_value(v, index) - (1 / mass[node]) * residual);
  }
  system.v.touched();
}

/// Takes the rigid bodies that have a mass to the velocities that go with what the nodes do, and the nodes to
/// these.
int HeldNodes::couple(System& system, DampingSolver& solver) {
  if (!coupling_) return 0;
  int iterations = 0;
  system.collisions.share_impulses(solver.reaction(), prescribed_, constraints_);
  const auto follow = [&](std::span<const RigidState> before) {
    for (std::size_t b = 0; b < before.size(); ++b)
      system.collisions.follow(system.rigid.bodies()[b], before[b]);
    join(prescribed_, system.collisions.constraints(), constraints_);
    iterations += solver.refine(system.v, constraints_);
    system.collisions.share_impulses(solver.reaction(), prescribed_, constraints_);
  };
  coupling_->solve(system, std::cref(follow));  // by reference: a function of its own would be allocated
  return iterations;
}

void HeldNodes::finish(System& system, StepReport& report) {
  if (coupling_) coupling_->finish(system);
  account_for_obstacles(system, report.dt);
  report.contacts = system.collisions.contacts();
  report.notes = system.collisions.take_notes();
}

Vec3d exerted(std::span<const NodeConstraint> constraints, std::span<const double> reaction) {
  Vec3d sum{};
  for (const auto& c : constraints) {
    const auto r = node_value(reaction, c.node);
    sum += r - c.free * r;
  }
  return sum;
}

void account_for_mass_damping(System& system, std::span<const double> v, double dt) {
  const auto damping = system.elastic.mass_damping();
  for (std::size_t node = 0; node < damping.size(); ++node)
    system.impulses.damping -= dt * damping[node] * node_value(v, static_cast<std::ptrdiff_t>(node));
}

void account_for_gravity(System& system, double dt) {
  for (const double m : system.mass_row_sums()) system.impulses.gravity += dt * m * system.gravity;
}

/// Every rank has all bodies: one of them counts what they got.
void account_for_obstacles(System& system, double dt) {
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

}  // namespace evert
