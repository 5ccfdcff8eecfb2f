#pragma once
#include "evert/forces/kernels/node_access.hpp"

#include <limits>

/// Forces of one tetrahedron without a torque.  PHYSICS 9
namespace evert::filtered {

/// x of J x = b for a symmetric positive semidefinite J. Where J is singular (nodes in a line or a point), so
/// is b, and x stays finite.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> solve_semidefinite(const Mat3<T>& j, const Vec3<T>& b) {
  using Limits = std::numeric_limits<scalar_t<T>>;
  const T smallest = T(Limits::epsilon()) * trace(j) + T(Limits::min());
  const T one = T(1.0);
  const T i0 = one / max(j(0, 0), smallest);
  const T l10 = j(1, 0) * i0, l20 = j(2, 0) * i0;
  const T i1 = one / max(j(1, 1) - l10 * j(1, 0), smallest);
  const T rest = j(2, 1) - l20 * j(1, 0);
  const T l21 = rest * i1;
  const T d2 = max(j(2, 2) - l20 * j(2, 0) - l21 * rest, smallest);
  const T y1 = b[1] - l10 * b[0];
  const T y2 = b[2] - l20 * b[0] - l21 * y1;
  const T x2 = y2 / d2;
  const T x1 = y1 * i1 - l21 * x2;
  return {b[0] * i0 - l10 * x1 - l20 * x2, x1, x2};
}

/// Takes the torque off forces whose sum is zero, given for all nodes but the first: f_a −= β × r_a with
/// (Σ|r|²I − r rᵀ) β = Σ r × f, r from the centroid of the nodes. That is the smallest change, and none at
/// rest, where the stress has no torque.
template <Real T>
EVERT_ALWAYS_INLINE void remove_torque(const kernels::Edges<T, 4>& edges, kernels::Edges<T, 4>& f) {
  const Vec3<T> centroid = T(0.25) * (edges[0] + edges[1] + edges[2]);
  Vec3<T> torque = cross(edges[0], f[0]) + cross(edges[1], f[1]) + cross(edges[2], f[2]);
  Mat3<T> squares = outer(centroid, centroid);  // of the first node
  for (const auto& edge : edges) squares += outer(edge - centroid, edge - centroid);
  const Vec3<T> beta = solve_semidefinite(trace(squares) * identity<T>() - squares, torque);
  for (std::size_t a = 0; a < 3; ++a) f[a] -= cross(beta, edges[a] - centroid);
}

}  // namespace evert::filtered
