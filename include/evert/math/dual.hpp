#pragma once
#include "evert/math/pack.hpp"

namespace evert {

/// A number and its derivative along one direction (forward mode): run a kernel on Dual instead of double and
/// read the exact directional derivative beside the value. For tests and set-up code.
///
///   Dual<double> x{2.0, 1.0};        // d/dx at x = 2
///   (x * log(x)).derivative;         // ln 2 + 1
template <Real T>
struct Dual {
  T value;
  T derivative;

  Dual() = default;
  constexpr Dual(T constant) : value(constant), derivative(0) {}
  constexpr Dual(T value_, T derivative_) : value(value_), derivative(derivative_) {}

  // clang-format off
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.derivative + b.derivative}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.derivative - b.derivative}; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.derivative}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.value * b.value, a.derivative * b.value + a.value * b.derivative}; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T quotient = a.value / b.value;
    return {quotient, (a.derivative - quotient * b.derivative) / b.value};
  }
  friend Dual& operator+=(Dual& a, const Dual& b) { return a = a + b; }
  friend Dual& operator-=(Dual& a, const Dual& b) { return a = a - b; }
  friend Dual& operator*=(Dual& a, const Dual& b) { return a = a * b; }
  friend Dual& operator/=(Dual& a, const Dual& b) { return a = a / b; }

  // Comparisons are those of the values.
  friend auto operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend auto operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend auto operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend auto operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

  friend Dual select(const mask_t<T>& mask, const Dual& a, const Dual& b) {
    return {evert::select(mask, a.value, b.value), evert::select(mask, a.derivative, b.derivative)};
  }
  friend Dual min(const Dual& a, const Dual& b) { return select(b < a, b, a); }
  friend Dual max(const Dual& a, const Dual& b) { return select(b > a, b, a); }
  friend Dual abs(const Dual& a) { return multiply_sign(a, a); }
  friend Dual copysign(const Dual& magnitude, const Dual& sign) { return multiply_sign(abs(magnitude), sign); }
  friend Dual multiply_sign(const Dual& a, const Dual& sign) {
    return {evert::multiply_sign(a.value, sign.value), evert::multiply_sign(a.derivative, sign.value)};
  }
  friend Dual sqrt(const Dual& a) {
    const T root = evert::sqrt(a.value);
    return {root, a.derivative / (root + root)};
  }
  friend Dual log(const Dual& a) { return {evert::log(a.value), a.derivative / a.value}; }
  friend Dual exp(const Dual& a) {
    const T power = evert::exp(a.value);
    return {power, a.derivative * power};
  }
  // clang-format on
};

}  // namespace evert
