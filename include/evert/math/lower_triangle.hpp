#pragma once
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

namespace evert {

/// A 3×3 matrix without entries above its diagonal, row after row.
template <class T>
struct LowerTriangle {
  T l00{1}, l10{0}, l11{1}, l20{0}, l21{0}, l22{1};
};

template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> matrix(const LowerTriangle<T>& l) {
  const T zero(0);
  return {{{{l.l00, l.l10, l.l20}, {zero, l.l11, l.l21}, {zero, zero, l.l22}}}};
}

template <class T>
EVERT_ALWAYS_INLINE constexpr T determinant(const LowerTriangle<T>& l) {
  return l.l00 * l.l11 * l.l22;
}

template <class T>
EVERT_ALWAYS_INLINE constexpr LowerTriangle<T> operator*(const Factor<T>& s, const LowerTriangle<T>& l) {
  return {s * l.l00, s * l.l10, s * l.l11, s * l.l20, s * l.l21, s * l.l22};
}

/// L⁻¹; not finite where the diagonal has a zero.
template <class T>
EVERT_ALWAYS_INLINE constexpr LowerTriangle<T> inverse(const LowerTriangle<T>& l) {
  const T one(1);
  const T d0 = one / l.l00, d1 = one / l.l11, d2 = one / l.l22;
  const T i10 = -(l.l10 * d0) * d1;
  const T i21 = -(l.l21 * d1) * d2;
  return {d0, i10, d1, -(l.l20 * d0 + l.l21 * i10) * d2, i21, d2};
}

/// A L
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> operator*(const Mat3<T>& a, const LowerTriangle<T>& l) {
  const auto& [a0, a1, a2] = a.column;
  return {l.l00 * a0 + l.l10 * a1 + l.l20 * a2, l.l11 * a1 + l.l21 * a2, l.l22 * a2};
}

/// Σ L_ij²
template <class T>
EVERT_ALWAYS_INLINE constexpr T square_norm(const LowerTriangle<T>& l) {
  return (l.l00 * l.l00 + l.l11 * l.l11 + l.l22 * l.l22) + (l.l10 * l.l10 + l.l20 * l.l20 + l.l21 * l.l21);
}

/// L of M = Q L with a rotation Q and a positive diagonal; det M > 0. L is that of every Q M: what of M does
/// not depend on how the world behind it is turned.
template <Real T>
EVERT_ALWAYS_INLINE LowerTriangle<T> lower_factor(const Mat3<T>& m) {
  const auto& [m0, m1, m2] = m.column;
  LowerTriangle<T> l;
  l.l22 = sqrt(dot(m2, m2));
  const Vec3<T> q2 = (T(1) / l.l22) * m2;
  l.l21 = dot(q2, m1);
  l.l20 = dot(q2, m0);
  const Vec3<T> r1 = m1 - l.l21 * q2;
  l.l11 = sqrt(dot(r1, r1));
  const Vec3<T> q1 = (T(1) / l.l11) * r1;
  l.l10 = dot(q1, m0);
  l.l00 = dot(cross(q1, q2), m0);
  return l;
}

}  // namespace evert
