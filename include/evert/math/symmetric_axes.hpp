#pragma once
#include "evert/math/svd3_stages.hpp"

/// Principal values and axes of a symmetric 3×3 tensor, branch-free and without its singular value
/// decomposition: the stages of svd3_stages.hpp, which need one frame and no square where the tensor is
/// symmetric.
///
///   deviator        E − tr(E)/3 I, in the place of FᵀF
///   isolated_root, isolated_direction, frame_along    the best separated axis w, and [w u v]
///   symmetric_plane what is left on the plane of u and v
namespace evert {

/// A symmetric tensor in the frame [w u v]: `isolated` w wᵀ + [u v] (mean I + reflection) [u v]ᵀ.
template <class T>
struct SymmetricPlane {
  T isolated, mean;
  PlaneVector<T> reflection;
};

/// Of a symmetric tensor; only the stages named above read it. Entries up to 1e70; deviators below 1e-30
/// count as zero.
template <Real T>
EVERT_ALWAYS_INLINE NormalizedSquare<T> deviator(const Mat3<T>& e) {
  using Scalar = scalar_t<T>;
  const T mean = T(Scalar(1) / Scalar(3)) * trace(e);
  NormalizedSquare<T> d;
  d.inverse_mean_square = T(1);
  d.b00 = e(0, 0) - mean;
  d.b11 = e(1, 1) - mean;
  d.b22 = e(2, 2) - mean;
  d.b01 = e(1, 0);
  d.b02 = e(2, 0);
  d.b12 = e(2, 1);
  const T q01 = d.b01 * d.b01, q02 = d.b02 * d.b02, q12 = d.b12 * d.b12;
  const T square = (d.b00 * d.b00 + d.b11 * d.b11) + (d.b22 * d.b22 + T(2) * (q01 + q02 + q12));
  d.spread = max(square * T(Scalar(1) / Scalar(6)), T(Scalar(1e-60)));
  d.half_determinant = T(0.5) * ((d.b00 * d.b11) * d.b22 + T(2) * (d.b01 * d.b02) * d.b12 -
                                 (d.b00 * q12 + d.b11 * q02 + d.b22 * q01));
  return d;
}

/// What is neglected, wᵀ E [u v], is rounding of the largest value.
template <Real T>
EVERT_ALWAYS_INLINE SymmetricPlane<T> symmetric_plane(const Mat3<T>& e, const Frame<T>& axes) {
  const Vec3<T> eu = e * axes.first, ev = e * axes.second;
  const T m00 = dot(axes.first, eu), m01 = dot(axes.second, eu), m11 = dot(axes.second, ev);
  const T x = T(0.5) * (m00 - m11);
  return {dot(axes.normal, e * axes.normal), T(0.5) * (m00 + m11), {x, m01, sqrt(x * x + m01 * m01)}};
}

/// In the order that symmetric_tensor() takes values in: that of w, the larger and the smaller of the plane.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> principal_values(const SymmetricPlane<T>& plane) {
  return {plane.isolated, plane.mean + plane.reflection.length, plane.mean - plane.reflection.length};
}

/// The tensor with the same axes and the principal values `p`.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> symmetric_tensor(const Frame<T>& axes, const SymmetricPlane<T>& plane,
                                             const Vec3<T>& p) {
  const T mean = T(0.5) * (p[1] + p[2]), half_difference = T(0.5) * (p[1] - p[2]);
  const auto direction = unit_direction(plane.reflection);
  const T x = half_difference * direction.cosine, y = half_difference * direction.sine;
  return outer(p[0] * axes.normal, axes.normal) +
         outer((mean + x) * axes.first + y * axes.second, axes.first) +
         outer(y * axes.first + (mean - x) * axes.second, axes.second);
}

/// All stages at once.
template <class T>
struct SymmetricAxes {
  Frame<T> axes;
  SymmetricPlane<T> plane;
};

/// Any finite symmetric E; NaN gives NaN.
template <Real T>
EVERT_ALWAYS_INLINE SymmetricAxes<T> symmetric_axes(const Mat3<T>& e) {
  const auto d = deviator(e);
  const auto axes = frame_along(isolated_direction(d, isolated_root(d)));
  return {axes, symmetric_plane(e, axes)};
}

}  // namespace evert
