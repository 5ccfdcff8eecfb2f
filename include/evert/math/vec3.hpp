#pragma once
#include <array>
#include <cstddef>

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

// clang-format off
template <class T> constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
template <class T> constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
template <class T> constexpr Vec3<T> operator-(const Vec3<T>& a) { return {-a[0], -a[1], -a[2]}; }
template <class T> constexpr Vec3<T> operator*(const T& s, const Vec3<T>& a) { return {s * a[0], s * a[1], s * a[2]}; }
template <class T> constexpr Vec3<T> operator*(const Vec3<T>& a, const T& s) { return s * a; }
template <class T> constexpr Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) { return a = a + b; }
template <class T> constexpr Vec3<T>& operator-=(Vec3<T>& a, const Vec3<T>& b) { return a = a - b; }
template <class T> constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
template <class T> constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// clang-format on

/// 3×3 matrix stored by columns: `m.column[j][i]` is row i, column j.
template <class T>
struct Mat3 {
  std::array<Vec3<T>, 3> column;

  constexpr T& operator()(std::size_t i, std::size_t j) { return column[j][i]; }
  constexpr const T& operator()(std::size_t i, std::size_t j) const { return column[j][i]; }
  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

using Mat3d = Mat3<double>;

}  // namespace evert
