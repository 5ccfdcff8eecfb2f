#pragma once
#include "evert/math/vec3.hpp"

#include <array>
#include <cstddef>

/// The trilinear hexahedron as a tensor product: what its shape functions do to the eight corners is done
/// axis by axis, by two operators of one dimension from the two ends of an edge to the two Gauss points on
/// it.
///
///   interpolation   I = [½(1+g) ½(1−g); ½(1−g) ½(1+g)],  g = 1/√3
///   slope           D = ½(end − start), the same at both points
///
/// ∂/∂ξ₀ = I₂I₁D₀, ∂/∂ξ₁ = I₂D₁I₀, ∂/∂ξ₂ = D₂I₁I₀: 80 operations (a fused multiplication and addition is one)
/// for one component of a field at all eight points, where multiplying with the shape gradients takes 168.
namespace evert::kernels {

/// Values on the corners of a cube or square, the first axis fastest; so are the Gauss points of hex8
/// counted.
template <class T>
using Cube = std::array<T, 8>;
template <class T>
using Square = std::array<T, 4>;

/// VTK goes round the faces.
inline constexpr std::array<std::size_t, 8> cube_corner_of_node{0, 1, 3, 2, 4, 5, 7, 6};

namespace detail {

inline constexpr double gauss_point = 0.57735026918962576451;  // 1/√3
inline constexpr double near_weight = 0.5 * (1 + gauss_point);
inline constexpr double far_weight = 0.5 * (1 - gauss_point);

/// Corner `side` (0 or 1) of edge number `edge` along `axis`.
EVERT_ALWAYS_INLINE constexpr std::size_t corner(std::size_t axis, std::size_t edge, std::size_t side) {
  const std::size_t stride = std::size_t{1} << axis;
  return edge % stride + edge / stride * 2 * stride + side * stride;
}

}  // namespace detail

/// From corners to Gauss points along `axis`. I is symmetric, so this is its transpose too.
template <std::size_t axis, class T, std::size_t count>
EVERT_ALWAYS_INLINE constexpr std::array<T, count> interpolated(const std::array<T, count>& values) {
  const T near = T(detail::near_weight), far = T(detail::far_weight);
  std::array<T, count> result;
  for (std::size_t edge = 0; edge < count / 2; ++edge) {
    const std::size_t start = detail::corner(axis, edge, 0), end = detail::corner(axis, edge, 1);
    result[start] = near * values[start] + far * values[end];
    result[end] = far * values[start] + near * values[end];
  }
  return result;
}

/// The slope of every edge along `axis`.
template <std::size_t axis, class T>
EVERT_ALWAYS_INLINE constexpr Square<T> slopes(const Cube<T>& values) {
  Square<T> result;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    result[edge] = T(0.5) * (values[detail::corner(axis, edge, 1)] - values[detail::corner(axis, edge, 0)]);
  }
  return result;
}

/// The transpose of slopes(), of what is summed over both points of every edge.
template <std::size_t axis, class T>
EVERT_ALWAYS_INLINE constexpr Cube<T> slopes_transposed(const Square<T>& sums) {
  Cube<T> result;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const T half = T(0.5) * sums[edge];
    result[detail::corner(axis, edge, 0)] = -half;
    result[detail::corner(axis, edge, 1)] = half;
  }
  return result;
}

template <class T>
EVERT_ALWAYS_INLINE constexpr Cube<T> sum_of(const Cube<T>& a, const Cube<T>& b) {
  Cube<T> sum;
  for (std::size_t i = 0; i < 8; ++i) sum[i] = a[i] + b[i];
  return sum;
}

/// A number of every edge, at both its points.
template <std::size_t axis, class T, class Store>
EVERT_ALWAYS_INLINE constexpr void for_points_of_edges(const Square<T>& of_edges, Store&& store) {
  for (std::size_t edge = 0; edge < 4; ++edge) {
    store(detail::corner(axis, edge, 0), of_edges[edge]);
    store(detail::corner(axis, edge, 1), of_edges[edge]);
  }
}

/// The sum over the two points of every edge.
template <std::size_t axis, class T, class At>
EVERT_ALWAYS_INLINE constexpr Square<T> sums_over_edges(At&& at) {
  Square<T> sums;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    sums[edge] = at(detail::corner(axis, edge, 0)) + at(detail::corner(axis, edge, 1));
  }
  return sums;
}

/// `store(q, k, ∂u/∂ξ_k at point q)` for a scalar field u given at the corners.
template <class T, class Store>
EVERT_ALWAYS_INLINE constexpr void reference_gradients(const Cube<T>& u, Store&& store) {
  const auto along = [&]<std::size_t axis>(const Square<T>& of_edges) {
    for_points_of_edges<axis>(of_edges, [&](std::size_t q, const T& value) { store(q, axis, value); });
  };
  // The axes left of a square keep their order.
  along.template operator()<0>(interpolated<1>(interpolated<0>(slopes<0>(u))));
  const Cube<T> u0 = interpolated<0>(u);
  along.template operator()<1>(interpolated<1>(slopes<1>(u0)));
  along.template operator()<2>(slopes<2>(interpolated<1>(u0)));
}

/// The transpose: Σ_q Σ_k ∂N_a/∂ξ_k at(q, k) for every corner a.
template <class T, class At>
EVERT_ALWAYS_INLINE constexpr Cube<T> reference_gradients_transposed(At&& at) {
  const auto sums = [&]<std::size_t axis>() {
    return sums_over_edges<axis, T>([&](std::size_t q) { return at(q, axis); });
  };
  const Cube<T> u1 = interpolated<1>(slopes_transposed<2>(sums.template operator()<2>()));
  const Cube<T> u0 =
      interpolated<0>(sum_of(u1, slopes_transposed<1>(interpolated<1>(sums.template operator()<1>()))));
  return sum_of(u0, slopes_transposed<0>(interpolated<0>(interpolated<1>(sums.template operator()<0>()))));
}

}  // namespace evert::kernels
