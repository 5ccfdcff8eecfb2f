#pragma once
#include "evert/math/pack.hpp"

#include <cmath>
#include <unordered_set>

/// A scalar that counts: the kernels are templates, and say themselves how much they compute and read.
namespace evert::bench {

/// What Counted has done so far. Each number read or written in memory is listed once, however often that
/// happens: the second time it is in a cache.
struct OperationLog {
  double flops = 0;      ///< divisions included
  double divisions = 0;  ///< and square roots
  std::unordered_set<const double*> read;
  std::unordered_set<const double*> written;
};

/// A double in the place of a pack of one lane. Additions, subtractions, multiplications, divisions and
/// square roots count one each; comparing, selecting and changing signs count nothing.
class Counted {
 public:
  Counted() = default;
  Counted(double value) : value_(value) {}  // NOLINT: constants convert, as those of packs

  [[nodiscard]] double value() const { return value_; }
  static OperationLog& so_far();

  /// What load(), store() and lane() of math/pack.hpp call of a pack.
  static Counted load(const double* from) noexcept;
  static Counted load(const float* from);  ///< of measures, which are not counted
  void store(double* to) const noexcept;
  double operator[](std::size_t /*lane*/) const { return value_; }

  friend Counted operator+(const Counted& a, const Counted& b) { return counted(a.value_ + b.value_); }
  friend Counted operator-(const Counted& a, const Counted& b) { return counted(a.value_ - b.value_); }
  friend Counted operator*(const Counted& a, const Counted& b) { return counted(a.value_ * b.value_); }
  friend Counted operator/(const Counted& a, const Counted& b) { return divided(a.value_ / b.value_); }
  friend Counted operator-(const Counted& a) { return -a.value_; }
  friend Counted& operator+=(Counted& a, const Counted& b) { return a = a + b; }
  friend Counted& operator-=(Counted& a, const Counted& b) { return a = a - b; }
  friend Counted& operator*=(Counted& a, const Counted& b) { return a = a * b; }
  friend Counted& operator/=(Counted& a, const Counted& b) { return a = a / b; }
  friend bool operator<(const Counted& a, const Counted& b) { return a.value_ < b.value_; }
  friend bool operator>(const Counted& a, const Counted& b) { return a.value_ > b.value_; }
  friend bool operator<=(const Counted& a, const Counted& b) { return a.value_ <= b.value_; }
  friend bool operator>=(const Counted& a, const Counted& b) { return a.value_ >= b.value_; }

  friend Counted sqrt(const Counted& x) { return divided(std::sqrt(x.value_)); }
  /// As many as evert::log and evert::exp of a pack take.
  friend Counted log(const Counted& x) noexcept;
  friend Counted exp(const Counted& x) noexcept;
  friend Counted abs(const Counted& x) { return std::abs(x.value_); }
  friend Counted min(const Counted& a, const Counted& b) { return b < a ? b : a; }
  friend Counted max(const Counted& a, const Counted& b) { return b > a ? b : a; }
  friend Counted copysign(const Counted& x, const Counted& sign) {
    return std::copysign(x.value_, sign.value_);
  }
  friend Counted multiply_sign(const Counted& x, const Counted& sign) {
    return evert::multiply_sign(x.value_, sign.value_);
  }
  friend Counted floor_power_of_two(const Counted& x) { return evert::floor_power_of_two(x.value_); }
  friend Counted select(bool mask, const Counted& a, const Counted& b) { return mask ? a : b; }

 private:
  // Out of line: in line in every expression of every kernel they take the compiler minutes.
  static Counted counted(double value) noexcept;
  static Counted divided(double value) noexcept;

  double value_ = 0;
};

}  // namespace evert::bench

namespace evert::detail {

template <>
struct PackTraits<bench::Counted> {
  using Scalar = double;
  using Mask = bool;
  static constexpr std::size_t lanes = 1;
};

}  // namespace evert::detail
