#pragma once
#include <cmath>

/// A number with one derivative, to check hand-written derivatives to rounding.
namespace evert::test {

struct Dual {
  double value = 0;
  double slope = 0;

  Dual() = default;
  explicit Dual(double constant, double derivative = 0) : value(constant), slope(derivative) {}

  friend Dual operator+(Dual a, Dual b) { return Dual(a.value + b.value, a.slope + b.slope); }
  friend Dual operator-(Dual a, Dual b) { return Dual(a.value - b.value, a.slope - b.slope); }
  friend Dual operator*(Dual a, Dual b) {
    return Dual(a.value * b.value, a.slope * b.value + a.value * b.slope);
  }
  friend Dual operator/(Dual a, Dual b) {
    return Dual(a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value);
  }
  friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
};

inline Dual max(Dual a, Dual b) { return b.value > a.value ? b : a; }
inline Dual select(bool mask, Dual a, Dual b) { return mask ? a : b; }
inline Dual log(Dual a) { return Dual(std::log(a.value), a.slope / a.value); }

}  // namespace evert::test
