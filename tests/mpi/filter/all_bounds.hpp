#pragma once
#include "evert/filter/collatz_wielandt.hpp"
#include "evert/filter/element_limits.hpp"
#include "evert/filter/spectrum.hpp"
#include "evert/math/nodal.hpp"

namespace evert::test {

/// All that is known of λmax(M⁻¹K) of a body [1/s²].
struct AllBounds {
  double truth, eq9, eq8_lower, eq8_upper, collatz_wielandt, lanczos;
};

/// Collective.
inline AllBounds all_bounds(const DistributedMesh& mesh, const ElasticForces& elastic, NodeField& x) {
  MassScaledStiffness stiffness(mesh, elastic);
  stiffness.assemble(x);
  const auto limits = element_limits(mesh, elastic, x);
  return {.truth = fastest_mode(stiffness).squared_frequency,
          .eq9 = limits.largest_of_own,
          .eq8_lower = limits.largest_of_nodal,
          .eq8_upper = limits.most_cells_a_node * limits.largest_of_nodal,
          .collatz_wielandt = collatz_wielandt_bound(stiffness.mat()),
          .lanczos = lanczos_estimate(stiffness)};
}

/// Positions map(rest position) of all local nodes.
template <class Map>
NodeField placed(const DistributedMesh& mesh, Map&& map) {
  NodeField x(mesh);
  for (LocalIndex i = 0; i < mesh.local_nodes(); ++i)
    set_node_value(x.local(), i, map(mesh.rest_positions[static_cast<std::size_t>(i)]));
  x.touched();
  return x;
}

inline NodeField at_rest(const DistributedMesh& mesh) {
  return placed(mesh, [](const Vec3d& rest) { return rest; });
}

}  // namespace evert::test
