#pragma once
#include "evert/core/index.hpp"
#include "evert/elements/element_view.hpp"
#include "evert/elements/shape_layout.hpp"
#include "evert/math/vec3.hpp"

#include <cstddef>
#include <span>

/// What a quadrature point of a cell at rest contributes.  paper A, section 4
namespace evert {

/// D_m H = ∂X/∂ξ at point `q` of the cell with the nodes `cell`.
[[nodiscard]] Mat3d rest_jacobian(const ElementView& element, std::size_t q, std::span<const LocalIndex> cell,
                                  std::span<const Vec3d> rest_positions);

/// |∂X/∂ξ| W there [m³].
[[nodiscard]] inline double point_volume(const ElementView& element, std::size_t q, const Mat3d& jacobian) {
  return element.weight(q) * determinant(jacobian);
}

/// The rotation Q that makes Qᵀ v_j triangular, of the vectors in the columns of `first_vectors`. To
/// rounding, whatever their lengths and angles.
[[nodiscard]] Mat3d triangular_frame(const Mat3d& first_vectors);

/// The vectors v_j of a point of a cell as the world sees them (shape_layout.hpp).
class RestVectors {
 public:
  RestVectors(const ElementView& element, ShapeData kind, std::size_t q, const Mat3d& jacobian)
      : element_(element), kind_(kind), point_(q), inverse_jacobian_(inverse(jacobian)) {}

  [[nodiscard]] Vec3d operator[](std::size_t j) const {
    return kind_ == ShapeData::inverse_jacobian
               ? Vec3d{inverse_jacobian_(j, 0), inverse_jacobian_(j, 1), inverse_jacobian_(j, 2)}
               : transpose_times(inverse_jacobian_, element_.gradient(point_, j + 1));
  }
  /// Q of the cell: how it is turned.
  [[nodiscard]] Mat3d frame() const {
    const bool turned = rest_layout(kind_, element_.nodes(), element_.points()).triangular;
    return turned ? triangular_frame({(*this)[0], (*this)[1], (*this)[2]}) : identity<double>();
  }

 private:
  ElementView element_;
  ShapeData kind_;
  std::size_t point_;
  Mat3d inverse_jacobian_;
};

}  // namespace evert
