#pragma once
#include "evert/core/index.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/math/vec3.hpp"

#include <cstddef>
#include <span>

/// What a quadrature point of a cell at rest contributes.  paper A, section 4
namespace evert {

/// D_m H = ∂X/∂ξ at point `q` of the cell with the nodes `cell`.
template <int nodes, int points>
Mat3d rest_jacobian(const ReferenceElement<nodes, points>& element, std::size_t q,
                    std::span<const LocalIndex> cell, std::span<const Vec3d> rest_positions) {
  Mat3d jacobian{};
  for (std::size_t a = 0; a < cell.size(); ++a) {
    jacobian += outer(rest_positions[static_cast<std::size_t>(cell[a])], element.gradients[q][a]);
  }
  return jacobian;
}

}  // namespace evert
