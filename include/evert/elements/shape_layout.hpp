#pragma once
#include <cstddef>

/// How the rest shape of elements is kept.
///
/// Of each quadrature point a few vectors v_j are kept: the shape gradients of all nodes but the first, or,
/// of tensor products, the rows of (∂X/∂ξ)⁻¹.
///
/// Nothing that Evert computes depends on how a cell at rest is turned, so a cell of one point is turned
/// until its first three vectors are triangular, v_j with j + 1 components: 6 numbers a tetrahedron, not 9,
/// to keep, to read and to multiply by. Its F is then F Q of the world's F; directions at rest (fibres) are
/// turned along. Points of one cell must not be turned each in its own way: the stiffness of the cell at rest
/// is a sum over them.
namespace evert {

/// What is kept of the rest shape at each quadrature point.
enum class ShapeData {
  node_gradients,  ///< ∂N_a/∂X of every node but the first, whose gradient is minus their sum [1/m]; for
                   ///< tet4 these are the rows of D_m⁻¹
  inverse_jacobian,  ///< the rows of (∂X/∂ξ)⁻¹; for elements that are tensor products
};

/// Where the components of the vectors of a point stand in its list of numbers.
struct ShapeLayout {
  std::size_t vectors = 0;
  bool triangular = false;  ///< v_j has only its first j + 1 components, others are zero (j < 3)

  /// Of vector number j.
  [[nodiscard]] constexpr std::size_t components(std::size_t j) const {
    return triangular && j < 3 ? j + 1 : 3;
  }
  /// Where vector number j begins.
  [[nodiscard]] constexpr std::size_t begin(std::size_t j) const {
    if (!triangular) return 3 * j;
    return j < 3 ? j * (j + 1) / 2 : 3 * j - 3;
  }
  [[nodiscard]] constexpr std::size_t numbers() const { return begin(vectors); }
};

[[nodiscard]] constexpr ShapeLayout rest_layout(ShapeData kind, std::size_t nodes, std::size_t points) {
  return {kind == ShapeData::inverse_jacobian ? 3 : nodes - 1, points == 1};
}

}  // namespace evert
