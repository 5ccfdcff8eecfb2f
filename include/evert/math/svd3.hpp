#pragma once
#include "evert/math/svd3_stages.hpp"

/// Rotation-variant SVD of a 3×3 matrix, F = U diag(σ) Vᵀ with det U = det V = +1, and isotropic functions of
/// F that never form U and V.  paper A, section 5; PHYSICS 2
namespace evert {

/// F = u · diag(sigma) · vᵀ with det u = det v = +1, |σ1| ≥ |σ2| ≥ |σ3|, σ1, σ2 ≥ 0, and σ3 < 0 exactly when
/// det F < 0 (where |σ3| is below the rounding of σ1, its sign is too).
template <class T>
struct Svd3 {
  Mat3<T> u;
  Vec3<T> sigma;
  Mat3<T> v;
};

/// The result of all stages, from which U, σ, V and every isotropic function of F follow. `right` and `left`
/// are the frames [w u v] and [l e f].
template <class T>
struct Deflation {
  Frame<T> right;
  Frame<T> left;
  PlaneRemainder<T> plane;  ///< of F / scale
  T root;                   ///< > 0: w and l belong to σ1; < 0: to σ3
  T scale;                  ///< power of two
};

/// The power of two that brings the largest |entry| of F into [1, 2), and F divided by it, which is exact.
/// Subnormal and enormous matrices are brought as near as a normal factor allows.
template <class T>
struct ScaledMatrix {
  Mat3<T> f;
  T scale;
};

template <Real T>
EVERT_ALWAYS_INLINE ScaledMatrix<T> scale_to_unit(const Mat3<T>& f) {
  constexpr scalar_t<T> smallest = std::numeric_limits<scalar_t<T>>::min();
  T largest = T(0);
  for (const auto& column : f.column) {
    for (const T& entry : column.components) largest = max(largest, abs(entry));
  }
  const T scale = floor_power_of_two(min(max(largest, T(smallest)), T(1 / smallest)));
  return {f * (T(1) / scale), scale};
}

/// Runs the stages. Any F; NaN and ∞ give NaN.
template <Real T>
EVERT_ALWAYS_INLINE Deflation<T> deflate(const Mat3<T>& any_f) {
  const auto [f, scale] = scale_to_unit(any_f);
  const auto square = normalized_square(f);
  const auto isolated = isolated_root(square);
  const auto right = frame_along(isolated_direction(square, isolated));
  const auto f_right = images(f, right);
  const auto left = frame_along(left_direction(f_right, right, square, isolated));
  return {right, left, plane_remainder(f_right, left), isolated.root, scale};
}

/// The principal stretches in the order isotropic_tensor wants them: that of (l, w), then the larger and the
/// smaller of the plane. Signs are those of Svd3: at most one is negative, the smallest in magnitude:
/// component 0 when root < 0, else component 2. Component 1 ≥ |component 2|.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> principal_stretches(const PlaneRemainder<T>& plane) {
  return {plane.isolated_stretch, plane.rotation.length + plane.reflection.length,
          plane.rotation.length - plane.reflection.length};
}

template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> principal_stretches(const Deflation<T>& d) {
  return d.scale * principal_stretches(d.plane);
}

/// U diag(p) Vᵀ, with p in the order of principal_stretches: the value of any isotropic tensor function of F,
/// given its principal values. Where U and V are not unique, the result is that of one valid choice.
///
/// l wᵀ p_0 + [e f] (½(p_1 + p_2) rotation + ½(p_1 − p_2) reflection) [u v]ᵀ, rotation and reflection
/// normalised.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> isotropic_tensor(const Frame<T>& left, const PlaneRemainder<T>& plane,
                                             const Frame<T>& right, const Vec3<T>& p) {
  const T half = T(0.5);
  const T mean = half * (p[1] + p[2]), half_difference = half * (p[1] - p[2]);
  const auto rotation = unit_direction(plane.rotation);
  const auto reflection = unit_direction(plane.reflection);
  const T rotation_x = mean * rotation.cosine, rotation_y = mean * rotation.sine;
  const T reflection_x = half_difference * reflection.cosine,
          reflection_y = half_difference * reflection.sine;
  const Vec3<T> l = p[0] * left.normal;
  const Vec3<T> left_u = (rotation_x + reflection_x) * left.first + (rotation_y + reflection_y) * left.second;
  const Vec3<T> left_v = (reflection_y - rotation_y) * left.first + (rotation_x - reflection_x) * left.second;
  return outer(l, right.normal) + outer(left_u, right.first) + outer(left_v, right.second);
}

template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> isotropic_tensor(const Deflation<T>& d, const Vec3<T>& p) {
  return isotropic_tensor(d.left, d.plane, d.right, p);
}

/// The rotation U Vᵀ, that is isotropic_tensor with p = (1, 1, 1).
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> polar_rotation(const Frame<T>& left, const PlaneRemainder<T>& plane,
                                           const Frame<T>& right) {
  const auto rotation = unit_direction(plane.rotation);
  const Vec3<T> left_u = rotation.cosine * left.first + rotation.sine * left.second;
  const Vec3<T> left_v = rotation.cosine * left.second - rotation.sine * left.first;
  return outer(left.normal, right.normal) + outer(left_u, right.first) + outer(left_v, right.second);
}

template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> polar_rotation(const Deflation<T>& d) {
  return polar_rotation(d.left, d.plane, d.right);
}

/// U, σ and V from the stages: M = Rot(φ) diag(σ) Rot(ψ)ᵀ, where φ − ψ is the angle of the rotation part and
/// φ + ψ that of the reflection part.
template <Real T>
EVERT_ALWAYS_INLINE Svd3<T> assemble_svd3(const Deflation<T>& d) {
  const auto a = half_angle(d.plane.reflection);
  const auto b = half_angle(d.plane.rotation);
  const T left_cosine = a.cosine * b.cosine - a.sine * b.sine,
          left_sine = a.sine * b.cosine + a.cosine * b.sine;
  const T right_cosine = a.cosine * b.cosine + a.sine * b.sine,
          right_sine = a.sine * b.cosine - a.cosine * b.sine;
  const Vec3<T> left_first = left_cosine * d.left.first + left_sine * d.left.second;
  const Vec3<T> left_second = left_cosine * d.left.second - left_sine * d.left.first;
  const Vec3<T> right_first = right_cosine * d.right.first + right_sine * d.right.second;
  const Vec3<T> right_second = right_cosine * d.right.second - right_sine * d.right.first;

  // Cyclic orders (l e f) and (e f l) keep det = +1.
  const auto is_largest = d.root > T(0);
  Svd3<T> svd;
  for (std::size_t i = 0; i < 3; ++i) {
    svd.u(i, 0) = select(is_largest, d.left.normal[i], left_first[i]);
    svd.u(i, 1) = select(is_largest, left_first[i], left_second[i]);
    svd.u(i, 2) = select(is_largest, left_second[i], d.left.normal[i]);
    svd.v(i, 0) = select(is_largest, d.right.normal[i], right_first[i]);
    svd.v(i, 1) = select(is_largest, right_first[i], right_second[i]);
    svd.v(i, 2) = select(is_largest, right_second[i], d.right.normal[i]);
  }
  const Vec3<T> stretch = principal_stretches(d);
  svd.sigma[0] = select(is_largest, stretch[0], stretch[1]);
  // Equal stretches may be out of order by their rounding.
  svd.sigma[1] = min(select(is_largest, stretch[1], stretch[2]), svd.sigma[0]);
  svd.sigma[2] = max(min(select(is_largest, stretch[2], stretch[0]), svd.sigma[1]), -svd.sigma[1]);
  return svd;
}

/// The SVD of any F. In double ‖F − U diag(σ) Vᵀ‖ / ‖F‖, ‖UᵀU − I‖ and ‖VᵀV − I‖ are at most 1e-14 (tested;
/// the worst of 80 million seen is 3.3e-15), for zero, flat, inverted and repeated cases and entries of any
/// magnitude up to 2^1021 (above, σ1 may overflow; subnormal σ are rounded to their spacing). Small σ are
/// accurate relative to σ1. NaN and ∞ give NaN.
template <class T>
EVERT_ALWAYS_INLINE Svd3<T> svd3(const Mat3<T>& f) {
  return assemble_svd3(deflate(f));
}

}  // namespace evert
