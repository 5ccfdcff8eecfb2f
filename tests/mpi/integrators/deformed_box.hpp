#pragma once
#include "evert/contact/velocity_constraints.hpp"
#include "evert/math/nodal.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <array>
#include <cmath>
#include <vector>

/// A state to try solves on.
namespace evert::test {

/// Waves of `amplitude` on the rest positions, and a velocity: the same for any number of ranks.
inline void deform(const DistributedMesh& mesh, double amplitude, NodeField& x, NodeField& v) {
  for (LocalIndex i = 0; i < mesh.local_nodes(); ++i) {
    const auto rest = mesh.rest_positions[static_cast<std::size_t>(i)];
    const Vec3d wave{std::sin(3 * rest[1]), 0.2 * std::cos(5 * rest[2]), 0.3 * std::sin(4 * rest[0])};
    set_node_value(x.local(), i, rest + amplitude * wave);
    set_node_value(v.local(), i, {std::cos(7 * rest[2]), std::sin(5 * rest[0]), std::cos(rest[1])});
  }
  x.touched();
  v.touched();
}

/// Every third node of a rank may not move along a slanted normal, and its node 0 is held altogether.
inline std::vector<NodeConstraint> some_constraints(const DistributedMesh& mesh) {
  std::vector<NodeConstraint> list;
  if (mesh.owned_nodes > 0) list.push_back({0, Mat3d{}, {{1, 2, 3}}});
  const Vec3d n{{0.6, 0, 0.8}};
  for (LocalIndex i = 3; i < mesh.owned_nodes; i += 3)
    list.push_back({i, projector_off(std::array{n}), 0.5 * n});
  return list;
}

}  // namespace evert::test
