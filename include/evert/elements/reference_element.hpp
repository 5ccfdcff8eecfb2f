#pragma once
#include "evert/elements/element_view.hpp"

#include <array>
#include <span>

/// The reference elements: one aggregate each. A new element is one more aggregate and its name in
/// AllReferenceElements.
namespace evert {

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

namespace detail {

/// Wedge: the triangle ξ, η ≥ 0, ξ + η ≤ 1 times −1 ≤ ζ ≤ 1; three points of the triangle times two Gauss
/// points, which integrate quadratic functions exactly in both.
constexpr ReferenceElement<6, 6> make_wedge6() {
  constexpr double gauss = 0.57735026918962576451;  // 1/√3
  constexpr std::array<std::array<double, 2>, 3> slopes{{{-1, -1}, {1, 0}, {0, 1}}};
  ReferenceElement<6, 6> wedge{.type = CellType::wedge6, .weights = {}, .values = {}, .gradients = {}};
  for (std::size_t q = 0; q < 6; ++q) {
    const double zeta = q < 3 ? -gauss : gauss;
    wedge.weights[q] = 1.0 / 6;
    for (std::size_t a = 0; a < 6; ++a) {
      const double side = a < 3 ? -1 : 1;
      const double along = 0.5 * (1 + side * zeta);
      const double in_triangle = a % 3 == q % 3 ? 2.0 / 3 : 1.0 / 6;
      wedge.values[q][a] = in_triangle * along;
      wedge.gradients[q][a] = {slopes[a % 3][0] * along, slopes[a % 3][1] * along, 0.5 * side * in_triangle};
    }
  }
  return wedge;
}

/// Quadratic tetrahedron ξ, η, ζ ≥ 0, ξ + η + ζ ≤ 1: corners, then the middles of the edges 01 12 20 03
/// 13 23. Four points at barycentric coordinates (5 + 3√5)/20 and (5 − √5)/20 integrate quadratic functions
/// exactly.
constexpr ReferenceElement<10, 4> make_tet10() {
  constexpr double near = 0.58541019662496845446, far = 0.13819660112501051518;
  constexpr std::array<Vec3d, 4> slopes{{{{-1, -1, -1}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  ReferenceElement<10, 4> tet{.type = CellType::tet10, .weights = {}, .values = {}, .gradients = {}};
  for (std::size_t q = 0; q < 4; ++q) {
    tet.weights[q] = 1.0 / 24;
    std::array<double, 4> barycentric{far, far, far, far};
    barycentric[q] = near;
    for (std::size_t a = 0; a < 4; ++a) {
      const double l = barycentric[a];
      tet.values[q][a] = l * (2 * l - 1);
      tet.gradients[q][a] = (4 * l - 1) * slopes[a];
    }
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = edges[e];
      tet.values[q][4 + e] = 4 * barycentric[i] * barycentric[j];
      tet.gradients[q][4 + e] = (4 * barycentric[i]) * slopes[j] + (4 * barycentric[j]) * slopes[i];
    }
  }
  return tet;
}

}  // namespace detail

inline constexpr ReferenceElement<6, 6> wedge6 = detail::make_wedge6();
inline constexpr ReferenceElement<10, 4> tet10 = detail::make_tet10();

/// A list of reference elements.
template <const auto&... elements>
struct ReferenceElements {};

/// Every cell type that carries elements.
using AllReferenceElements = ReferenceElements<tet4, hex8, wedge6, tet10>;

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

/// The reference element of `type`. Throws UserError for types without one.
[[nodiscard]] ElementView reference_element(CellType type);

}  // namespace evert
