#include "evert/integrators/held_nodes.hpp"

#include "evert/core/log.hpp"
#include "evert/math/nodal.hpp"

#include <array>

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

HeldNodes::HeldNodes(const System& system) { constraints_.reserve(system.masses().size()); }

HeldNodes::Kinds HeldNodes::collide(System& system, const NodeField& predicted, double dt) {
  const PhaseScope scope(Phase::contact);
  constraints_.clear();
  prescribed_ = {};
  if (!system.collisions.any_obstacles() && system.prescribed.empty()) return {};
  prescribed_ = system.prescribed.at(system.time + dt);
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
  int iterations = 0;
  auto reaction = solver.reaction();
  for (int pass = 0; pass < most_friction_passes; ++pass) {
    if (obeys_coulomb(system, reaction)) break;
    collisions.slide(system.v.owned(), reaction);
    join(prescribed_, collisions.constraints(), constraints_);
    iterations += solver.refine(system.v, constraints_);
    reaction = solver.reaction();
  }
  collisions.stop_reversed(system.v.owned());
  impose(prescribed_, system.v.owned());
  system.v.touched();
  const auto by_prescription = exerted(prescribed_, reaction);
  system.impulses.constraint += by_prescription;
  system.impulses.contact +=
      exerted(constraints_, reaction) - by_prescription + collisions.friction() + collisions.impulse();
  return iterations;
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
  for (const double m : system.masses()) system.impulses.gravity += dt * m * system.gravity;
}

}  // namespace evert
