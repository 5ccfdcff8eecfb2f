#pragma once
#include "evert/materials/lame.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <string_view>

namespace evert {

/// Soft for small strains and stiff for large ones, by a cubic spline of the stress through given slopes,
/// with a linear pressure: P̂_i = 2μ D(σ_i − 1) + λ Σ(σ_j − 1).  paper A, section 6.1; PHYSICS 3
///
/// D(s) = s + (k − 1)/(3a²) s³ up to a limit |s| = a, where its slope, 1 at rest, has become k; beyond, D
/// continues linearly. a and k may differ for compression and elongation. Finite everywhere, through flat and
/// inverted, with P̂ C¹ but in its slope at the limits: there is nothing to extend.
struct Spline {
  static constexpr std::string_view name = "spline";
  static constexpr double default_compression_limit = 0.5;
  static constexpr double default_elongation_limit = 1.5;
  static constexpr double default_stiffening = 10;  ///< that of the hexahedra in paper A's gears

  Lame lame{};                                           ///< of small strains, unless a limit is 1
  double compression_limit = default_compression_limit;  ///< stretch in [0, 1]; at 1 all compression is stiff
  double elongation_limit = default_elongation_limit;    ///< stretch ≥ 1; at 1 all elongation is stiff
  double compression_stiffening = default_stiffening;    ///< k below compression_limit, > 0
  double elongation_stiffening = default_stiffening;     ///< k above elongation_limit, > 0

  /// Energy density ψ(σ) [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    const T trace = strain[0] + strain[1] + strain[2];
    return T(2 * lame.mu) * (energy_along(strain[0]) + energy_along(strain[1]) + energy_along(strain[2])) +
           T(0.5 * lame.lambda) * trace * trace;
  }

  /// P̂ = ∂ψ/∂σ [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    const T pressure = T(lame.lambda) * (strain[0] + strain[1] + strain[2]);
    const auto along = [&](std::size_t i) {
      const Parts<T> at = parts(strain[i]);
      return T(2 * lame.mu) * (below().cubic(at.below) + above().cubic(at.above) +
                               T(below().outside) * at.beyond_below + T(above().outside) * at.beyond_above) +
             pressure;
    };
    return {along(0), along(1), along(2)};
  }

  /// ∂²ψ/∂σ² [Pa], symmetric.
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_derivative(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    const T off = T(lame.lambda);
    const auto on = [&](std::size_t i) { return T(2 * lame.mu) * slope_along(strain[i]) + off; };
    return {{{{on(0), off, off}, {off, on(1), off}, {off, off, on(2)}}}};
  }

  /// (P̂_i − P̂_j)/(σ_i − σ_j) [Pa] and its limit, of the pair without axis 0, 1, 2.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    const auto pair = [&](std::size_t i, std::size_t j) {
      return T(2 * lame.mu) * divided_difference(strain[i], strain[j]);
    };
    return {pair(1, 2), pair(0, 2), pair(0, 1)};
  }

 private:
  /// D on one side of rest: inside · s + third · s³ up to the limit, then with slope `outside`.
  struct Side {
    double inside, third, outside;

    template <class T>
    EVERT_ALWAYS_INLINE T cubic(const T& s) const {
      return s * (T(inside) + T(third) * (s * s));
    }
    template <class T>
    EVERT_ALWAYS_INLINE T slope(const T& s) const {
      return T(inside) + T(3 * third) * (s * s);
    }
    /// (cubic(s) − cubic(t))/(s − t)
    template <class T>
    EVERT_ALWAYS_INLINE T divided_difference(const T& s, const T& t) const {
      return T(inside) + T(third) * (s * s + s * t + t * t);
    }
    /// ∫ D of a strain that is s inside and `beyond` outside.
    template <class T>
    EVERT_ALWAYS_INLINE T energy(const T& s, const T& beyond) const {
      const T square = s * s;
      return square * (T(0.5 * inside) + T(0.25 * third) * square) +
             beyond * (cubic(s) + T(0.5 * outside) * beyond);
    }
  };

  EVERT_ALWAYS_INLINE static Side side(double width, double stiffening) {
    if (width > 0) return {1, (stiffening - 1) / (3 * width * width), stiffening};
    return {stiffening, 0, stiffening};
  }
  EVERT_ALWAYS_INLINE Side below() const { return side(1 - compression_limit, compression_stiffening); }
  EVERT_ALWAYS_INLINE Side above() const { return side(elongation_limit - 1, elongation_stiffening); }

  /// A strain as the sum of four: compression and elongation, up to the limit and beyond.
  template <class T>
  struct Parts {
    T below, beyond_below;  ///< ≤ 0
    T above, beyond_above;  ///< ≥ 0
  };

  template <class T>
  EVERT_ALWAYS_INLINE Parts<T> parts(const T& strain) const {
    const T compression = min(strain, T(0.0));
    const T elongation = strain - compression;
    const T below = max(compression, T(compression_limit - 1));
    const T above = min(elongation, T(elongation_limit - 1));
    return {below, compression - below, above, elongation - above};
  }

  template <class T>
  EVERT_ALWAYS_INLINE static Vec3<T> strains(const Vec3<T>& sigma) {
    return {sigma[0] - T(1.0), sigma[1] - T(1.0), sigma[2] - T(1.0)};
  }

  template <class T>
  EVERT_ALWAYS_INLINE T energy_along(const T& strain) const {
    const Parts<T> at = parts(strain);
    return below().energy(at.below, at.beyond_below) + above().energy(at.above, at.beyond_above);
  }

  template <class T>
  EVERT_ALWAYS_INLINE T slope_along(const T& strain) const {
    const Parts<T> at = parts(strain);
    // At the limit the cubic has the slope of what follows.
    return select(strain < T(0.0), below().slope(at.below), above().slope(at.above));
  }

  /// (D(s) − D(t))/(s − t). The parts up to the limits are s and t or constants, so that their differences
  /// are exact however near the two are; what is beyond is the rest.
  template <class T>
  EVERT_ALWAYS_INLINE T divided_difference(const T& s, const T& t) const {
    const Parts<T> at_s = parts(s);
    const Parts<T> at_t = parts(t);
    const auto apart = abs(s - t) > T(0.0);
    const T inverse = T(1.0) / select(apart, s - t, T(1.0));
    const T compressed = (min(s, T(0.0)) - min(t, T(0.0))) * inverse;
    const T below_share = (at_s.below - at_t.below) * inverse;
    const T above_share = (at_s.above - at_t.above) * inverse;
    const T quotient = below_share * below().divided_difference(at_s.below, at_t.below) +
                       above_share * above().divided_difference(at_s.above, at_t.above) +
                       T(below().outside) * (compressed - below_share) +
                       T(above().outside) * (T(1.0) - compressed - above_share);
    return select(apart, quotient, slope_along(s));
  }
};

}  // namespace evert
