#pragma once
#include "evert/core/index.hpp"
#include "evert/elements/reference_element.hpp"
#include "evert/elements/shape_layout.hpp"
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

/// The rotation Q that makes Qᵀ v_j triangular, of the vectors in the columns of `first_vectors`. To
/// rounding, whatever their lengths and angles.
[[nodiscard]] Mat3d triangular_frame(const Mat3d& first_vectors);

/// The vectors of point `q` of a cell as the world sees them.
template <int nodes, int points>
struct RestVectors {
  ShapeData kind;
  const ReferenceElement<nodes, points>& element;
  std::size_t q;
  Mat3d inverse_jacobian;

  [[nodiscard]] Vec3d operator[](std::size_t j) const {
    return kind == ShapeData::inverse_jacobian
               ? Vec3d{inverse_jacobian(j, 0), inverse_jacobian(j, 1), inverse_jacobian(j, 2)}
               : transpose_times(inverse_jacobian, element.gradients[q][j + 1]);
  }
  /// Q of the cell: how it is turned (shape_layout.hpp).
  [[nodiscard]] Mat3d frame() const {
    return points == 1 ? triangular_frame({(*this)[0], (*this)[1], (*this)[2]}) : identity<double>();
  }
};

}  // namespace evert
