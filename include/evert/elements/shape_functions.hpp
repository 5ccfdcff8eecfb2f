#pragma once
#include "evert/elements/element_view.hpp"
#include "evert/math/vec3.hpp"

#include <array>
#include <vector>

/// The shape functions of a cell type anywhere in its reference cell; a ReferenceElement has them at the
/// points of its own quadrature only.
namespace evert {

/// N_a at `xi`; those beyond the nodes of the type are 0. Reference cells are those of the elements in
/// reference_element.hpp. Instantiated for double and Dual<double>.
template <class T>
[[nodiscard]] std::array<T, most_nodes> shape_functions(CellType type, const Vec3<T>& xi);

/// A quadrature rule on the reference cell, with the shape functions at its points.
struct ShapeQuadrature {
  struct Point {
    double weight;
    std::array<double, most_nodes> values;    ///< N_a
    std::array<Vec3d, most_nodes> gradients;  ///< ∂N_a/∂ξ
  };
  std::size_t nodes = 0;
  std::vector<Point> points;
};

/// Integrates N_a N_b |∂X/∂ξ| exactly, of cells with curved edges and warped faces too.
[[nodiscard]] ShapeQuadrature mass_quadrature(CellType type);

}  // namespace evert
