#pragma once
#include "evert/elements/element_block.hpp"
#include "evert/elements/reference_element.hpp"

#include <array>
#include <cstddef>

namespace evert {

template <int nodes>
using NodeVectors = std::array<Vec3d, nodes>;

/// Numbers of one lane among those of a batch.
class LaneNumbers {
 public:
  /// Of the cell in lane number `slot` of all lanes, which has `per_lane` numbers.
  LaneNumbers(const NumberArray& numbers, std::size_t per_lane, std::size_t lanes, std::size_t slot)
      : numbers_(numbers), first_(slot / lanes * lanes * per_lane + slot % lanes), lanes_(lanes) {}

  [[nodiscard]] double number(std::size_t i) const { return numbers_[first_ + i * lanes_]; }
  /// The i-th of its vectors, and of its matrices by columns.
  [[nodiscard]] Vec3d vector(std::size_t i) const {
    return {number(3 * i), number(3 * i + 1), number(3 * i + 2)};
  }
  [[nodiscard]] Mat3d matrix(std::size_t i) const {
    return {vector(3 * i), vector(3 * i + 1), vector(3 * i + 2)};
  }

 private:
  const NumberArray& numbers_;
  std::size_t first_, lanes_;
};

/// The shape gradients of all nodes at point `q` of a cell whose shape data are `numbers`.
template <int nodes, int points>
NodeVectors<nodes> read_gradients(const ReferenceElement<nodes, points>& element, ShapeData kind,
                                  const LaneNumbers& numbers, std::size_t q) {
  NodeVectors<nodes> gradients{};
  for (std::size_t a = 1; a < nodes; ++a) {
    gradients[a] = kind == ShapeData::inverse_jacobian
                       ? transpose_times(numbers.matrix(q), element.gradients[q][a])
                       : numbers.vector(q * (nodes - 1) + a - 1);
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
  const LaneNumbers shape(block.shapes, block.shapes.size() / block.cell_of_lane.size(), lanes, slot);
  const LaneNumbers volumes(block.volumes, points, lanes, slot);
  return {read_gradients(element, block.shape_data, shape, q), volumes.number(q)};
}

}  // namespace evert
