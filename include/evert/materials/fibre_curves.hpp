#pragma once
#include "evert/math/pack.hpp"

/// Tension along a fibre over its stretch, in units of the peak stress. Each is the exact slope of an energy,
/// and never negative: a fibre pulls and does not push.  PHYSICS 10; Teran et al. 2005
namespace evert {

/// What a fibre at rest puts up against being stretched, with s = stretch − 1: c (e^(rs) − rs − 1) for s > 0,
/// along its tangent from `linear_from` on, nothing when shortened.
struct PassiveCurve {
  double factor = 0.05;      ///< c ≥ 0
  double exponent = 6.6;     ///< r > 0
  double linear_from = 1.4;  ///< stretch ≥ 1

  template <class T>
  EVERT_ALWAYS_INLINE T tension(const T& stretch) const {
    const Terms<T> at = terms(stretch);
    return at.curved + at.slope * at.beyond;
  }

  /// ∫ of the tension from stretch 1.
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const T& stretch) const {
    const Terms<T> at = terms(stretch);
    // ∫ (e^(rs) − rs − 1) ds = (e^(rs) − 1 − rs − (rs)²/2)/r
    const T of_curve = T(1 / exponent) * (at.curved - T(0.5 * factor) * at.grown * at.grown);
    return of_curve + (at.curved + T(0.5) * at.slope * at.beyond) * at.beyond;
  }

  /// Slope of the tension.
  template <class T>
  EVERT_ALWAYS_INLINE T stiffness(const T& stretch) const {
    return terms(stretch).slope;
  }

 private:
  template <class T>
  struct Terms {
    T grown;   ///< r s, s between 0 and where the curve becomes straight
    T curved;  ///< tension there
    T slope;   ///< of the tension there
    T beyond;  ///< stretch in excess of it
  };

  template <class T>
  EVERT_ALWAYS_INLINE Terms<T> terms(const T& stretch) const {
    const T longer = max(stretch - T(1.0), T(0.0));
    const T within = min(longer, T(linear_from - 1));
    const T grown = T(exponent) * within;
    const T power = exp(grown) - T(1.0);
    return {grown, T(factor) * (power - grown), T(factor * exponent) * power, longer - within};
  }
};

/// The force-length curve of an active fibre, 1 − (s/w)² with s = stretch − 1, and zero for |s| ≥ w:
/// strongest at rest length.
struct ActiveCurve {
  double width = 0.6;  ///< w in (0, 1): a fibre that has shrunk to nothing must not pull

  template <class T>
  EVERT_ALWAYS_INLINE T tension(const T& stretch) const {
    const T s = part_of_width(stretch);
    return T(1.0) - s * s;
  }

  /// ∫ of the tension from stretch 1.
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const T& stretch) const {
    const T s = part_of_width(stretch);
    return T(width) * (s - T(1.0 / 3) * s * s * s);
  }

  /// Slope of the tension; the larger of the two where it jumps, at the lower end.
  template <class T>
  EVERT_ALWAYS_INLINE T stiffness(const T& stretch) const {
    const T s = part_of_width(stretch);
    const auto outside = abs(stretch - T(1.0)) > T(width);
    return select(outside, T(0.0), T(-2 / width) * s);
  }

 private:
  /// s/w within [−1, 1]; exactly ±1 outside, so that the tension is exactly 0.
  template <class T>
  EVERT_ALWAYS_INLINE T part_of_width(const T& stretch) const {
    return max(min((stretch - T(1.0)) / T(width), T(1.0)), T(-1.0));
  }
};

}  // namespace evert
