#pragma once
#include "evert/elements/element_block.hpp"
#include "evert/elements/reference_element.hpp"

#include <array>
#include <cstddef>

namespace evert {

template <int nodes>
using NodeVectors = std::array<Vec3d, nodes>;

/// A vector of one lane, [3][lane], and a matrix by columns.
inline Vec3d read_vector(const double* of_lane, std::size_t lanes) {
  return {of_lane[0], of_lane[lanes], of_lane[2 * lanes]};
}
inline Mat3d read_matrix(const double* of_lane, std::size_t lanes) {
  return {read_vector(of_lane, lanes), read_vector(of_lane + 3 * lanes, lanes),
          read_vector(of_lane + 6 * lanes, lanes)};
}

/// The shape gradients of all nodes at point `q` of one cell, from numbers [point][vector][3][lane] of the
/// given kind; `numbers` points at the cell's lane in its batch.
template <int nodes, int points>
NodeVectors<nodes> read_gradients(const ReferenceElement<nodes, points>& element, ShapeData kind,
                                  const double* numbers, std::size_t lanes, std::size_t q) {
  NodeVectors<nodes> gradients{};
  for (std::size_t a = 1; a < nodes; ++a) {
    if (kind == ShapeData::inverse_jacobian) {
      gradients[a] = transpose_times(read_matrix(numbers + 9 * q * lanes, lanes), element.gradients[q][a]);
    } else {
      gradients[a] = read_vector(numbers + 3 * (q * (nodes - 1) + a - 1) * lanes, lanes);
    }
    gradients[0] -= gradients[a];
  }
  return gradients;
}

/// A quadrature point of one cell, read back from the batches.
template <int nodes>
struct RestPoint {
  NodeVectors<nodes> gradients;  ///< ∂N_a/∂X
  double volume;                 ///< |∂X/∂ξ| W
};

/// Point `q` of the cell in lane number `slot` of all lanes.
template <int nodes, int points>
RestPoint<nodes> rest_point(const ReferenceElement<nodes, points>& element, const ElementBlock& block,
                            std::size_t slot, std::size_t q) {
  const auto lanes = static_cast<std::size_t>(block.lanes);
  const std::size_t batch = slot / lanes, lane = slot % lanes;
  const std::size_t numbers = block.shapes.size() / block.cell_of_lane.size();  // per lane
  return {read_gradients(element, block.shape_data, &block.shapes[batch * numbers * lanes + lane], lanes, q),
          block.volumes[(batch * points + q) * lanes + lane]};
}

}  // namespace evert
