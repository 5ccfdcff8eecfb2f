#pragma once
#include "evert/math/always_inline.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

/// Three-vectors and 3×3 matrices over any scalar: double, long double, a SIMD pack, a dual number.
namespace evert {

template <class T>
struct Vec3 {
  std::array<T, 3> components;

  constexpr T& operator[](std::size_t i) { return components[i]; }
  constexpr const T& operator[](std::size_t i) const { return components[i]; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3d = Vec3<double>;

/// 3×3 matrix stored by columns: `m.column[j][i]` is row i, column j.
template <class T>
struct Mat3 {
  std::array<Vec3<T>, 3> column;

  constexpr T& operator()(std::size_t i, std::size_t j) { return column[j][i]; }
  constexpr const T& operator()(std::size_t i, std::size_t j) const { return column[j][i]; }
  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

using Mat3d = Mat3<double>;

/// A factor of a Vec3<T> or Mat3<T>: whatever converts to T.
template <class T>
using Factor = std::type_identity_t<T>;

// clang-format off
// --- vectors
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> operator-(const Vec3<T>& a) { return {-a[0], -a[1], -a[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> operator*(const Factor<T>& s, const Vec3<T>& a) { return {s * a[0], s * a[1], s * a[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> operator*(const Vec3<T>& a, const Factor<T>& s) { return s * a; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) { return a = a + b; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T>& operator-=(Vec3<T>& a, const Vec3<T>& b) { return a = a - b; }
template <class T> EVERT_ALWAYS_INLINE constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Euclidean length. Overflows and underflows with the square.
template <class T> EVERT_ALWAYS_INLINE T norm(const Vec3<T>& a) { using std::sqrt; return sqrt(dot(a, a)); }

// --- matrices
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T> operator+(const Mat3<T>& a, const Mat3<T>& b) { return {a.column[0] + b.column[0], a.column[1] + b.column[1], a.column[2] + b.column[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T> operator-(const Mat3<T>& a, const Mat3<T>& b) { return {a.column[0] - b.column[0], a.column[1] - b.column[1], a.column[2] - b.column[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T> operator-(const Mat3<T>& a) { return {-a.column[0], -a.column[1], -a.column[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T> operator*(const Factor<T>& s, const Mat3<T>& a) { return {s * a.column[0], s * a.column[1], s * a.column[2]}; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T> operator*(const Mat3<T>& a, const Factor<T>& s) { return s * a; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T>& operator+=(Mat3<T>& a, const Mat3<T>& b) { return a = a + b; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T>& operator-=(Mat3<T>& a, const Mat3<T>& b) { return a = a - b; }
template <class T> EVERT_ALWAYS_INLINE constexpr Vec3<T> operator*(const Mat3<T>& a, const Vec3<T>& x) { return x[0] * a.column[0] + x[1] * a.column[1] + x[2] * a.column[2]; }
template <class T> EVERT_ALWAYS_INLINE constexpr Mat3<T> operator*(const Mat3<T>& a, const Mat3<T>& b) { return {a * b.column[0], a * b.column[1], a * b.column[2]}; }
// clang-format on

template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> transpose(const Mat3<T>& a) {
  return {{{{a(0, 0), a(0, 1), a(0, 2)}, {a(1, 0), a(1, 1), a(1, 2)}, {a(2, 0), a(2, 1), a(2, 2)}}}};
}

/// Aᵀ x
template <class T>
EVERT_ALWAYS_INLINE constexpr Vec3<T> transpose_times(const Mat3<T>& a, const Vec3<T>& x) {
  return {dot(a.column[0], x), dot(a.column[1], x), dot(a.column[2], x)};
}

/// Aᵀ B
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> transpose_times(const Mat3<T>& a, const Mat3<T>& b) {
  return {transpose_times(a, b.column[0]), transpose_times(a, b.column[1]), transpose_times(a, b.column[2])};
}

/// A Bᵀ
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> times_transpose(const Mat3<T>& a, const Mat3<T>& b) {
  return a * transpose(b);
}

/// a bᵀ
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> outer(const Vec3<T>& a, const Vec3<T>& b) {
  return {a * b[0], a * b[1], a * b[2]};
}

template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> diagonal(const Vec3<T>& d) {
  const T zero(0);
  return {{{{d[0], zero, zero}, {zero, d[1], zero}, {zero, zero, d[2]}}}};
}

template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> identity() {
  return diagonal<T>({T(1), T(1), T(1)});
}

template <class T>
EVERT_ALWAYS_INLINE constexpr T trace(const Mat3<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

/// Σ A_ij B_ij
template <class T>
EVERT_ALWAYS_INLINE constexpr T contract(const Mat3<T>& a, const Mat3<T>& b) {
  return dot(a.column[0], b.column[0]) + dot(a.column[1], b.column[1]) + dot(a.column[2], b.column[2]);
}

/// Frobenius norm. Overflows and underflows with the square.
template <class T>
EVERT_ALWAYS_INLINE T norm(const Mat3<T>& a) {
  using std::sqrt;
  return sqrt(contract(a, a));
}

template <class T>
EVERT_ALWAYS_INLINE constexpr T determinant(const Mat3<T>& a) {
  return dot(a.column[0], cross(a.column[1], a.column[2]));
}

/// det(A) A⁻ᵀ, defined for every A.
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> cofactor(const Mat3<T>& a) {
  return {cross(a.column[1], a.column[2]), cross(a.column[2], a.column[0]), cross(a.column[0], a.column[1])};
}

/// A⁻¹; not finite where det A = 0.
template <class T>
EVERT_ALWAYS_INLINE constexpr Mat3<T> inverse(const Mat3<T>& a) {
  const Mat3<T> cofactors = cofactor(a);
  return transpose(cofactors) * (T(1) / dot(a.column[0], cofactors.column[0]));
}

}  // namespace evert
