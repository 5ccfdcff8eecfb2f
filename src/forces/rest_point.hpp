#pragma once
#include "evert/elements/element_block.hpp"

#include <array>
#include <cstddef>

namespace evert {

/// A quadrature point of one cell, read back from the batches.
template <int nodes>
struct RestPoint {
  std::array<Vec3d, nodes> gradients;  ///< ∂N_a/∂X
  double volume;                       ///< |∂X/∂ξ| W
};

/// Point `q` of the cell in lane number `slot` of all lanes.
template <int nodes, int points>
RestPoint<nodes> rest_point(const ElementBlock& block, std::size_t slot, std::size_t q) {
  const auto lanes = static_cast<std::size_t>(block.lanes);
  const std::size_t point = slot / lanes * points + q;
  const std::size_t lane = slot % lanes;
  RestPoint<nodes> rest{};
  rest.volume = block.volumes[point * lanes + lane];
  for (std::size_t a = 1; a < nodes; ++a) {
    for (std::size_t i = 0; i < 3; ++i) {
      rest.gradients[a][i] = block.gradients[((point * (nodes - 1) + a - 1) * 3 + i) * lanes + lane];
    }
    rest.gradients[0] -= rest.gradients[a];
  }
  return rest;
}

}  // namespace evert
