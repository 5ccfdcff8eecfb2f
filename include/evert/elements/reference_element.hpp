#pragma once
#include "evert/math/vec3.hpp"
#include "evert/mesh/mesh.hpp"

#include <array>
#include <span>

/// The reference elements: one aggregate each. A new element is one more aggregate and its name in
/// AllReferenceElements.
namespace evert {

/// Shape functions and quadrature of one cell type on its reference cell ξ. Nodes in VTK's order.
template <int node_total, int point_total>
struct ReferenceElement {
  static constexpr int nodes = node_total;
  static constexpr int points = point_total;
  template <class Value>
  using PerPoint = std::array<Value, point_total>;
  template <class Value>
  using PerNode = std::array<Value, node_total>;

  CellType type;
  /// The shape functions are products of those of one dimension, and so are the points: gradients can be
  /// taken axis by axis, which needs no more of the rest shape than ∂X/∂ξ at each point
  /// (kernels/tensor_product.hpp).
  bool tensor_product = false;
  PerPoint<double> weights;            ///< W of paper A, section 4; they sum to the reference volume
  PerPoint<PerNode<double>> values;    ///< N_a at each point
  PerPoint<PerNode<Vec3d>> gradients;  ///< H: ∂N_a/∂ξ at each point
};

/// Linear tetrahedron: F is constant, one point at the centroid.
inline constexpr ReferenceElement<4, 1> tet4{
    .type = CellType::tet4,
    .weights = {1.0 / 6},
    .values = {{{0.25, 0.25, 0.25, 0.25}}},
    .gradients = {{{{{{-1, -1, -1}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}}}},
};

namespace detail {

/// Trilinear hexahedron on [−1, 1]³ with 2×2×2 Gauss points at ±1/√3, x fastest.
constexpr ReferenceElement<8, 8> make_hex8() {
  constexpr double gauss = 0.57735026918962576451;  // 1/√3
  constexpr std::array<Vec3d, 8> corners{{{{-1, -1, -1}},
                                          {{1, -1, -1}},
                                          {{1, 1, -1}},
                                          {{-1, 1, -1}},
                                          {{-1, -1, 1}},
                                          {{1, -1, 1}},
                                          {{1, 1, 1}},
                                          {{-1, 1, 1}}}};
  ReferenceElement<8, 8> hex{
      .type = CellType::hex8, .tensor_product = true, .weights = {}, .values = {}, .gradients = {}};
  for (std::size_t q = 0; q < 8; ++q) {
    const Vec3d xi{(q & 1) != 0 ? gauss : -gauss, (q & 2) != 0 ? gauss : -gauss,
                   (q & 4) != 0 ? gauss : -gauss};
    hex.weights[q] = 1;
    for (std::size_t a = 0; a < 8; ++a) {
      const Vec3d& corner = corners[a];
      const Vec3d factor{0.5 * (1 + corner[0] * xi[0]), 0.5 * (1 + corner[1] * xi[1]),
                         0.5 * (1 + corner[2] * xi[2])};
      hex.values[q][a] = factor[0] * factor[1] * factor[2];
      hex.gradients[q][a] = {0.5 * corner[0] * factor[1] * factor[2], 0.5 * corner[1] * factor[0] * factor[2],
                             0.5 * corner[2] * factor[0] * factor[1]};
    }
  }
  return hex;
}

}  // namespace detail

inline constexpr ReferenceElement<8, 8> hex8 = detail::make_hex8();

/// hex8 by the gradients of its shape functions, as an element that is no tensor product: to compare the two.
inline constexpr ReferenceElement<8, 8> hex8_by_gradients = [] {
  ReferenceElement<8, 8> general = hex8;
  general.tensor_product = false;
  return general;
}();

/// A list of reference elements.
template <const auto&... elements>
struct ReferenceElements {};

/// Every cell type that carries elements.
using AllReferenceElements = ReferenceElements<tet4, hex8>;

namespace detail {

/// Throws the UserError for a type without an element.
[[noreturn]] void throw_no_reference_element(CellType type, std::span<const CellType> allowed);

template <const auto&... elements>
[[noreturn]] void no_reference_element(CellType type, ReferenceElements<elements...> /*known*/) {
  throw_no_reference_element(type, std::array{elements.type...});
}

template <class Visitor, const auto& first, const auto&... rest>
auto visit_element(CellType type, Visitor& visit, ReferenceElements<first, rest...> /*candidates*/) {
  if (type == first.type) return visit(first);
  if constexpr (sizeof...(rest) > 0) {
    return visit_element(type, visit, ReferenceElements<rest...>{});
  } else {
    no_reference_element(type, AllReferenceElements{});
  }
}

}  // namespace detail

/// Calls `visit` with the reference element of `type` and returns its answer. Throws UserError for types
/// without one.
template <class Visitor>
auto with_reference_element(CellType type, Visitor&& visit) {
  return detail::visit_element(type, visit, AllReferenceElements{});
}

}  // namespace evert
