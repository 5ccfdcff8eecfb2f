#include "motion.hpp"

#include "evert/math/nodal.hpp"

#include <algorithm>

namespace evert {
namespace {

Motion motion_of_lumped(const System& system) {
  Motion motion;
  const auto mass = system.masses();
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto x = node_value(system.x.owned(), static_cast<std::ptrdiff_t>(i));
    const auto v = node_value(system.v.owned(), static_cast<std::ptrdiff_t>(i));
    motion.kinetic_energy += 0.5 * mass[i] * dot(v, v);
    motion.momentum += mass[i] * v;
    motion.angular_momentum += mass[i] * cross(x, v);
  }
  return motion;
}

/// Collective.
Motion motion_of_consistent(const System& system) {
  NodeField velocities(system.mesh), momenta(system.mesh);
  std::ranges::copy(system.v.owned(), velocities.owned().begin());
  velocities.touched();
  system.elastic.add_momentum(velocities, momenta);
  Motion motion;
  for (LocalIndex node = 0; node < system.mesh.owned_nodes; ++node) {
    const auto momentum = node_value(momenta.owned(), node);
    motion.kinetic_energy += 0.5 * dot(node_value(system.v.owned(), node), momentum);
    motion.momentum += momentum;
    motion.angular_momentum += cross(node_value(system.x.owned(), node), momentum);
  }
  return motion;
}

}  // namespace

Motion motion_of(const System& system) {
  return system.elastic.consistent_mass() == nullptr ? motion_of_lumped(system)
                                                     : motion_of_consistent(system);
}

}  // namespace evert
