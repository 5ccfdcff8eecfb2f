#pragma once
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <limits>

/// The stages of the 3×3 SVD by deflation, branch-free, each a function of its own so that a kernel can run
/// one stage at a time over packs that stay in L1. svd3.hpp puts them together.
///
///   normalized_square    B = FᵀF / mean eigenvalue − I, and its characteristic cubic
///   isolated_root        the eigenvalue of B farthest from the other two: that of σ1 or that of σ3
///   isolated_direction   its eigenvector w, completed by frame_along to a frame [w u v]
///   images               F [w u v]
///   left_direction       l along F w or F u × F v, completed by frame_along to a frame [l e f]
///   plane_remainder      [e f]ᵀ F [u v] in polar form
///
/// An eigenproblem of FᵀF loses half the digits of small singular values. Here only one direction comes from
/// it, the best separated one, which is accurate; the others come from F itself, which restores all digits
/// relative to σ1.
///
/// Range: the stages take F = 0 or any F whose largest entry lies between 1e-70 and 1e70 (float: 1e-7 and
/// 1e7); svd3 and deflate scale into it.
namespace evert {

namespace detail {

/// Lengths below this count as zero: their squares would lose digits to underflow.
template <class Scalar>
inline constexpr Scalar tiny_length = Scalar(0x1p-485);
template <>
inline constexpr float tiny_length<float> = 0x1p-51F;

template <class Scalar>
inline constexpr Scalar tiny_square = Scalar(0x1p-970);
template <>
inline constexpr float tiny_square<float> = 0x1p-102F;

}  // namespace detail

/// B = FᵀF · inverse_mean_square − I (trace 0; 0 for a scaled rotation).
template <class T>
struct NormalizedSquare {
  T b00, b11, b22, b01, b02, b12;
  T inverse_mean_square;  ///< 3 / tr FᵀF
  T spread;               ///< tr B² / 6, kept away from 0
  T half_determinant;     ///< det B / 2
};

/// The best separated eigenvalue of B is `root` / `inverse_spread`.
template <class T>
struct IsolatedRoot {
  T root;            ///< in [√3, 2] when it belongs to σ1, in [−2, −√3] when it belongs to σ3
  T inverse_spread;  ///< 1 / √(tr B² / 6)
};

/// Right-handed orthonormal basis: first × second = normal.
template <class T>
struct Frame {
  Vec3<T> normal, first, second;
};

/// A vector of the plane and its length.
template <class T>
struct PlaneVector {
  T x, y, length;
};

/// lᵀ F w and M = [e f]ᵀ F [u v] = rotation + reflection, where a rotation part is
/// [[x, −y], [y, x]] and a reflection part is [[x, y], [y, −x]]. The singular values of M, the second with
/// the sign of det M, are rotation.length ± reflection.length: no decision about signs is ever taken.
template <class T>
struct PlaneRemainder {
  T isolated_stretch;
  PlaneVector<T> rotation;
  PlaneVector<T> reflection;
};

template <Real T>
EVERT_ALWAYS_INLINE NormalizedSquare<T> normalized_square(const Mat3<T>& f) {
  using Scalar = scalar_t<T>;
  const auto& [f0, f1, f2] = f.column;
  const T s00 = dot(f0, f0), s11 = dot(f1, f1), s22 = dot(f2, f2);
  const T s01 = dot(f0, f1), s02 = dot(f0, f2), s12 = dot(f1, f2);

  NormalizedSquare<T> b;
  const T scale = T(3) / max(s00 + s11 + s22, T(detail::tiny_square<Scalar>));
  b.inverse_mean_square = scale;
  b.b00 = s00 * scale - T(1);
  b.b11 = s11 * scale - T(1);
  b.b22 = s22 * scale - T(1);
  b.b01 = s01 * scale;
  b.b02 = s02 * scale;
  b.b12 = s12 * scale;

  const T q01 = b.b01 * b.b01, q02 = b.b02 * b.b02, q12 = b.b12 * b.b12;
  const T trace_of_square = (b.b00 * b.b00 + b.b11 * b.b11) + (b.b22 * b.b22 + T(2) * (q01 + q02 + q12));
  // A spread below ε is rounding: any direction then serves, and the floor keeps 1/spread³ finite.
  constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
  b.spread = max(trace_of_square * T(Scalar(1) / Scalar(6)), T(epsilon * epsilon * epsilon));
  const T determinant =
      (b.b00 * b.b11) * b.b22 + T(2) * (b.b01 * b.b02) * b.b12 - (b.b00 * q12 + b.b11 * q02 + b.b22 * q01);
  b.half_determinant = T(0.5) * determinant;
  return b;
}

/// Largest root of x³ − 3x − 2g = 0 for 0 ≤ g ≤ 1, that is x = 2 cos(acos(g)/3): a minimax polynomial (error
/// 2e-8), then Newton. The root is simple on all of [0, 1], so this is accurate to rounding.
template <Real T>
EVERT_ALWAYS_INLINE T largest_cubic_root(const T& g) {
  using Scalar = scalar_t<T>;
  constexpr auto c = [](double coefficient) { return T(Scalar(coefficient)); };
  const T g2 = g * g;
  const T low =
      (c(1.73205082684) + c(0.333330653986) * g) + (c(-0.0961636335648) + c(0.0488376960173) * g) * g2;
  const T high =
      (c(-0.028728894114) + c(0.015546567546) * g) + (c(-0.00600318384539) + c(0.00112998640573) * g) * g2;
  T x = low + high * (g2 * g2);
  constexpr int newton_steps = std::numeric_limits<Scalar>::digits > 53 ? 2 : 1;
  for (int step = 0; step < newton_steps; ++step) {
    const T x2 = x * x;
    x = T(2) * (x2 * x + g) / (T(3) * x2 - T(3));
  }
  return x;
}

template <Real T>
EVERT_ALWAYS_INLINE IsolatedRoot<T> isolated_root(const NormalizedSquare<T>& b) {
  const T inverse_spread = T(1) / sqrt(b.spread);
  const T cosine = b.half_determinant * (inverse_spread * inverse_spread * inverse_spread);
  const T root = largest_cubic_root(min(abs(cosine), T(1)));
  return {copysign(root, cosine), inverse_spread};
}

/// The right singular vector w of the isolated value, not normalised: of the columns of
/// adj(B − λI) = (λ_2 − λ)(λ_3 − λ) w wᵀ the one with the largest diagonal.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> isolated_direction(const NormalizedSquare<T>& b,
                                               const IsolatedRoot<T>& isolated) {
  const T s = isolated.inverse_spread;
  const T c00 = b.b00 * s - isolated.root, c11 = b.b11 * s - isolated.root, c22 = b.b22 * s - isolated.root;
  const T c01 = b.b01 * s, c02 = b.b02 * s, c12 = b.b12 * s;

  const T a00 = c11 * c22 - c12 * c12, a11 = c00 * c22 - c02 * c02, a22 = c00 * c11 - c01 * c01;
  const T a01 = c02 * c12 - c01 * c22, a02 = c01 * c12 - c02 * c11, a12 = c01 * c02 - c12 * c00;

  const auto second = a11 > a00;
  const auto third = a22 > select(second, a11, a00);
  return {select(third, a02, select(second, a01, a00)), select(third, a12, select(second, a11, a01)),
          select(third, a22, select(second, a12, a02))};
}

/// The frame whose normal is `direction` (≠ 0) normalised, by one square root and one division.
/// Duff et al. 2017, Building an orthonormal basis, revisited.
template <Real T>
EVERT_ALWAYS_INLINE Frame<T> frame_along(const Vec3<T>& direction) {
  const T one = T(1);
  const T length_squared = dot(direction, direction);
  const T length = sqrt(length_squared);
  const T length_plus_z = length + abs(direction[2]);
  const T reciprocal = one / (length * length_plus_z);

  const Vec3<T> n = (length_plus_z * reciprocal) * direction;
  const T minus_h = -(length_squared * reciprocal);  // -1 / (1 + |n_z|)
  const T sign = copysign(one, direction[2]);
  const T x_h = minus_h * n[0];
  const T xy_h = x_h * n[1];
  return {n,
          {one + x_h * n[0], xy_h, -(sign * n[0])},
          {sign * xy_h, sign * (one + minus_h * n[1] * n[1]), -n[1]}};
}

/// [F w, F u, F v] as columns.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> images(const Mat3<T>& f, const Frame<T>& right) {
  return {f * right.normal, f * right.first, f * right.second};
}

/// The left singular vector l of the isolated value, not normalised. F w serves when w belongs to
/// σ1, the normal of the plane (F u, F v) when it belongs to σ3, where F w may vanish. F = 0 takes l = w.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> left_direction(const Mat3<T>& images, const Frame<T>& right,
                                           const NormalizedSquare<T>& b, const IsolatedRoot<T>& isolated) {
  using Scalar = scalar_t<T>;
  const auto& [fw, fu, fv] = images.column;
  const Vec3<T> plane_normal = b.inverse_mean_square * cross(fu, fv);
  const auto is_largest = isolated.root > T(0);
  const auto is_null = b.inverse_mean_square >= T(Scalar(3) / detail::tiny_square<Scalar>);
  Vec3<T> l;
  for (std::size_t i = 0; i < 3; ++i) {
    l[i] = select(is_null, right.normal[i], select(is_largest, fw[i], plane_normal[i]));
  }
  return l;
}

/// `left` is the frame [l e f]. What is neglected, [e f]ᵀ F w and lᵀ F [u v], is rounding of σ1.
template <Real T>
EVERT_ALWAYS_INLINE PlaneRemainder<T> plane_remainder(const Mat3<T>& images, const Frame<T>& left) {
  const auto& [fw, fu, fv] = images.column;
  const T m00 = dot(left.first, fu), m01 = dot(left.first, fv);
  const T m10 = dot(left.second, fu), m11 = dot(left.second, fv);
  const auto with_length = [](const T& x, const T& y) { return PlaneVector<T>{x, y, sqrt(x * x + y * y)}; };
  const T half = T(0.5);
  return {dot(left.normal, fw), with_length(half * (m00 + m11), half * (m10 - m01)),
          with_length(half * (m00 - m11), half * (m10 + m01))};
}

/// (cos θ, sin θ).
template <class T>
struct Direction2 {
  T cosine, sine;
};

/// Direction of a plane vector; (1, 0) where it has none.
template <Real T>
EVERT_ALWAYS_INLINE Direction2<T> unit_direction(const PlaneVector<T>& p) {
  using Scalar = scalar_t<T>;
  const T tiny = T(detail::tiny_length<Scalar>);
  const auto vanishes = p.length < tiny;
  const T inverse = T(1) / max(p.length, tiny);
  return {select(vanishes, T(1), p.x * inverse), select(vanishes, T(0), p.y * inverse)};
}

/// (cos θ/2, sin θ/2) for the angle −π ≤ θ ≤ π of a plane vector, without cancellation; (1, 0) where it has
/// none.
template <Real T>
EVERT_ALWAYS_INLINE Direction2<T> half_angle(const PlaneVector<T>& p) {
  using Scalar = scalar_t<T>;
  const T one = T(1), tiny = T(detail::tiny_length<Scalar>);
  const auto vanishes = p.length < tiny;
  const T length = max(p.length, tiny);
  const T sum = length + abs(p.x);
  const T inverse = one / sqrt(T(2) * length * sum);  // 1 / |(sum, y)|
  const T larger = select(vanishes, one, sum * inverse);
  const T smaller = select(vanishes, T(0), abs(p.y) * inverse);
  const auto acute = vanishes || p.x >= T(0);
  return {select(acute, larger, smaller), copysign(select(acute, smaller, larger), p.y)};
}

}  // namespace evert
