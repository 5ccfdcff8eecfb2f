#pragma once
#include "evert/filter/element_modes.hpp"
#include "evert/forces/elastic_block.hpp"
#include "evert/materials/tangent.hpp"
#include "evert/math/eigen_symmetric3.hpp"
#include "evert/math/svd3.hpp"

#include <array>
#include <span>

/// The matrices of one filtered tetrahedron, for assembly; its forces are in filtered_forces.hpp.  PHYSICS 9
namespace evert::filtered {

using Svd3d = Svd3<double>;

/// Turned at rest so that its strains stand along the axes of the filter: F is F Q of the world's F, as in
/// elements/shape_layout.hpp.
struct Cell {
  std::array<Vec3d, 4> gradients{};
  double volume = 0;
  StrainMap<double> filter{};
};

/// F, from differences, so that a common translation costs no digits.
inline Mat3d deformation_gradient(const Cell& cell, const CellNodes& nodes, const double* x) {
  const auto at = [&](std::size_t a) {
    const double* of_node = x + 3 * static_cast<std::ptrdiff_t>(nodes[a]);
    return Vec3d{of_node[0], of_node[1], of_node[2]};
  };
  Mat3d sum{};
  for (std::size_t a = 1; a < 4; ++a) sum += outer(at(a) - at(0), cell.gradients[a]);
  return sum;
}

/// What ∂P/∂F a stiffness matrix is made of: R and A outside of ∂σ/∂S̃. R is held, since with its change P has
/// no symmetric tangent; at rest nothing is missing.
class Tangent {
 public:
  template <class Model>
  Tangent(const Model& model, const Cell& cell, const Svd3d& f, bool projected)
      : cell_(cell), rotation_(times_transpose(f.u, f.v)) {
    const Vec3d elongation = f.sigma - Vec3d{1, 1, 1};
    const auto [strains, axes] =
        eigen_symmetric3(cell.filter(f.v * times_transpose(diagonal(elongation), f.v)));
    axes_ = axes;
    tangent_ = principal_tangent(model, strains + Vec3d{1, 1, 1});
    if (projected) tangent_ = positive_part(tangent_);
    tangent_.spin = {0, 0, 0};  // a strain has none
  }

  /// dP of dF.
  [[nodiscard]] Mat3d operator()(const Mat3d& change) const {
    const Mat3d turned = transpose_times(rotation_, change);
    const Mat3d strain = cell_.filter(0.5 * (turned + transpose(turned)));
    const Mat3d stress = axes_ * times_transpose(tangent_(transpose_times(axes_, strain * axes_)), axes_);
    return rotation_ * cell_.filter.transposed(stress);
  }

 private:
  const Cell& cell_;
  Mat3d rotation_, axes_{};
  PrincipalTangent<double> tangent_{};
};

/// Dense row-major 12×12 of a linear map from dF to |∂X/∂ξ| W dP.
template <class Map>
void fill_matrix(const Cell& cell, Map&& map, std::span<double> matrix) {
  for (std::size_t b = 0; b < 4; ++b) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3d unit{};
      unit[k] = 1;
      const Mat3d stress = map(outer(unit, cell.gradients[b]));
      for (std::size_t a = 0; a < 4; ++a) {
        const Vec3d force = stress * cell.gradients[a];
        for (std::size_t i = 0; i < 3; ++i) matrix[(3 * a + i) * 12 + 3 * b + k] = force[i];
      }
    }
  }
}

}  // namespace evert::filtered
