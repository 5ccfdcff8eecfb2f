#pragma once
#include "evert/filter/element_modes.hpp"
#include "evert/math/nodal.hpp"
#include "evert/math/svd3.hpp"
#include "evert/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace evert::test {

/// Collective. The largest |σ − 1| of any tetrahedron.
inline double largest_strain(const Simulation& simulation) {
  double largest = 0;
  const auto x = simulation.positions().local();
  for (const auto& entry : simulation.mesh().cells)
    for (std::size_t first = 0; first < entry.nodes.size(); first += 4) {
      const auto nodes = std::span(entry.nodes).subspan(first, 4);
      const auto shape = tet_shape(nodes, simulation.mesh().rest_positions);
      Mat3d f{};
      for (std::size_t a = 1; a < 4; ++a)
        f += outer(node_value(x, nodes[a]) - node_value(x, nodes[0]), shape.gradients[a]);
      for (const double stretch : svd3(f).sigma.components)
        largest = std::max(largest, std::abs(stretch - 1));
    }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, simulation.mesh().comm);
  return largest;
}

}  // namespace evert::test
