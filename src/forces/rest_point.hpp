#pragma once
#include "evert/elements/element_block.hpp"

#include <array>
#include <cstddef>

namespace evert {

/// One for each node of an element; the rest are zero.
using NodeVectors = std::array<Vec3d, most_nodes>;

/// Numbers of one lane among those of a batch.
class LaneNumbers {
 public:
  /// Of the cell in lane number `slot` of all lanes, which has `per_lane` numbers.
  LaneNumbers(const NumberArray& numbers, std::size_t per_lane, std::size_t lanes, std::size_t slot)
      : numbers_(numbers), first_(slot / lanes * lanes * per_lane + slot % lanes), lanes_(lanes) {}

  [[nodiscard]] double number(std::size_t i) const { return numbers_[first_ + i * lanes_]; }
  /// Vector number `j` of point `q`.
  [[nodiscard]] Vec3d vector(const ShapeLayout& layout, std::size_t q, std::size_t j) const {
    Vec3d v{0, 0, 0};
    for (std::size_t i = 0; i < layout.components(j); ++i)
      v[i] = number(q * layout.numbers() + layout.begin(j) + i);
    return v;
  }
  /// Matrix number `q`, by columns.
  [[nodiscard]] Mat3d matrix(std::size_t q) const {
    const ShapeLayout columns{.vectors = 3};
    return {vector(columns, q, 0), vector(columns, q, 1), vector(columns, q, 2)};
  }

 private:
  const NumberArray& numbers_;
  std::size_t first_, lanes_;
};

/// The shape gradients of all nodes at point `q` of a cell whose shape data are `numbers`.
inline NodeVectors read_gradients(const ElementView& element, ShapeData kind, const ShapeLayout& layout,
                                  const LaneNumbers& numbers, std::size_t q) {
  NodeVectors gradients{};
  for (std::size_t a = 1; a < element.nodes(); ++a) {
    if (kind == ShapeData::inverse_jacobian) {
      for (std::size_t k = 0; k < 3; ++k)
        gradients[a] += element.gradient(q, a)[k] * numbers.vector(layout, q, k);
    } else {
      gradients[a] = numbers.vector(layout, q, a - 1);
    }
    gradients[0] -= gradients[a];
  }
  return gradients;
}

/// A quadrature point of one cell, read back from the batches.
struct RestPoint {
  NodeVectors gradients;  ///< ∂N_a/∂X, turned as the cell is (shape_layout.hpp)
  double volume;          ///< |∂X/∂ξ| W
};

/// Point `q` of the cell in lane number `slot` of all lanes.
inline RestPoint rest_point(const ElementBlock& block, std::size_t slot, std::size_t q) {
  const ElementView& element = block.element;
  const auto lanes = static_cast<std::size_t>(block.lanes);
  const ShapeLayout layout = rest_layout(block.shape_data, element.nodes(), element.points());
  const LaneNumbers shape(block.shapes, element.points() * layout.numbers(), lanes, slot);
  const LaneNumbers volumes(block.volumes, element.points(), lanes, slot);
  return {read_gradients(element, block.shape_data, layout, shape, q), volumes.number(q)};
}

}  // namespace evert
