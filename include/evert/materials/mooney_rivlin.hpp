#pragma once
#include "evert/materials/compression_limit.hpp"
#include "evert/materials/lame.hpp"
#include "evert/math/vec3.hpp"

#include <string_view>

namespace evert {

/// Mooney-Rivlin solid, shape and volume apart: ψ = μ10 (Ī1 − 3) + μ01 (Ī2 − 3) + κ/2 (ln J)² with Ī1 =
/// J^(−2/3) Σσ_i², Ī2 = J^(2/3) Σσ_i⁻². The isotropic part of muscle.  PHYSICS 3 and 10
///
/// Small strains: μ = 2 (μ10 + μ01), bulk modulus κ.
///
/// Both invariants are sums of products of powers of the stretches, σ_i^p with p = ±4/3, ±2/3. Below the
/// compression limit ε each power is continued: with c = max(σ, ε), d = σ − c ≤ 0, r = d/c,
///
///   σ^p   →  c^p (1 + p r + p²r²/2)    c^p e^(pr), which is σ^p with ln σ continued linearly, to second
///   order ln J  →  L = Σ (ln c_i + r_i)      continued linearly
///
/// Stress is the exact gradient and continuous (C¹ energy). Below the limit every factor is positive and
/// convex in its stretch, and so is ψ: an element is pushed back the more, the more it is compressed or
/// inverted, whatever its other stretches are; linearly in the stretch. No branches: above the limit r = 0.
struct MooneyRivlin {
  static constexpr std::string_view name = "mooney_rivlin";
  /// The inverse powers make it stiffen sooner than neo-Hookean: here, at κ = μ, the uniaxial stiffness is 19
  /// times that at rest (stable step a quarter); at 0.25, the value of paper A's muscles, it is 48 times.
  static constexpr double default_compression_limit = 0.35;
  static constexpr double default_share_01 = 0.25;  ///< that of the muscles of paper A

  Lame lame{};
  double share_01 = default_share_01;                    ///< μ01/(μ10 + μ01) in [0, 1]
  double compression_limit = default_compression_limit;  ///< ε in (0, 1)
  Extension extension = Extension::linear;

  /// By the constants of the literature [Pa], `mu_10`, `mu_01` ≥ 0 and not both 0, `bulk_modulus` κ > 0.
  static constexpr MooneyRivlin from_constants(double mu_10, double mu_01, double bulk_modulus,
                                               double compression_limit = default_compression_limit,
                                               Extension extension = Extension::linear) {
    return {Lame::from_shear_bulk(2 * (mu_10 + mu_01), bulk_modulus), mu_01 / (mu_10 + mu_01),
            compression_limit, extension};
  }

  /// Energy density ψ(σ) [Pa]. With `clamp` that at the limited stretches, of which the stress is *not* the
  /// gradient.
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    return at.mu_10 * sum_of_products(at.first) - T(3 * mu_10()) + at.mu_01 * sum_of_products(at.second) -
           T(3 * mu_01()) + T(0.5 * lame.bulk_modulus()) * at.volume_log * at.volume_log;
  }

  /// P̂ = ∂ψ/∂σ [Pa]; with `clamp` P̂ at the limited stretches.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    const T pressure = T(lame.bulk_modulus()) * at.volume_log;
    const auto along = [&](std::size_t i) {
      return at.inverse[i] *
             (at.mu_10 * first_slope(at.first, i) + at.mu_01 * first_slope(at.second, i) + pressure);
    };
    return {along(0), along(1), along(2)};
  }

  /// ∂²ψ/∂σ² [Pa], symmetric; with `clamp` that at the limited stretches.
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_derivative(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    const T kappa = T(lame.bulk_modulus());
    const auto diagonal = [&](std::size_t i) {
      // c²(σ^p)'' = p² σ^p − p σ^p; the second part is that of the slope of 1/c, and gone below the limit.
      const T bent =
          at.mu_10 * first_slope(at.first, i) + at.mu_01 * first_slope(at.second, i) + kappa * at.volume_log;
      const T bent_above = select(at.sigma[i] < T(compression_limit), T(0.0), bent);
      return at.inverse[i] * at.inverse[i] *
             (at.mu_10 * curvature(at.first, i) + at.mu_01 * curvature(at.second, i) + kappa - bent_above);
    };
    const auto mixed = [&](std::size_t i, std::size_t j, std::size_t k) {
      return at.inverse[i] * at.inverse[j] *
             (at.mu_10 * second_slope(at.first, i, j, k) + at.mu_01 * second_slope(at.second, i, j, k) +
              kappa);
    };
    const T p01 = mixed(0, 1, 2);
    const T p02 = mixed(0, 2, 1);
    const T p12 = mixed(1, 2, 0);
    return {{{{diagonal(0), p01, p02}, {p01, diagonal(1), p12}, {p02, p12, diagonal(2)}}}};
  }

  /// (P̂_i − P̂_j)/(σ_i − σ_j) [Pa] and its limit, of the pair without axis 0, 1, 2.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    const auto pair = [&](std::size_t i, std::size_t j, std::size_t k) {
      const PairSlopes<T> slopes = pair_slopes(sigma[i], sigma[j], compression_limit, extension);
      const Differences<T> first = differences_of_first(at, slopes, i, j);
      const Differences<T> second = differences_of_second(at, slopes, i, j);
      return at.mu_10 * shear(at.first, at.inverse, first, i, j, k) +
             at.mu_01 * shear(at.second, at.inverse, second, i, j, k) -
             T(lame.bulk_modulus()) * at.volume_log * at.inverse[i] * at.inverse[j] * slopes.limited;
    };
    return {pair(1, 2, 0), pair(0, 2, 1), pair(0, 1, 2)};
  }

 private:
  /// Of one invariant, but for a factor common to all axes: Σ_i own_i others_j others_k. Slopes are those in
  /// r, of σ^p that is p σ^p above the limit.
  template <class T>
  struct Factors {
    Vec3<T> own;            ///< c^±2, continued as σ^±4/3
    Vec3<T> own_slope;      ///< ∂/∂r
    Vec3<T> own_curvature;  ///< ∂²/∂r², p² σ^p above the limit
    Vec3<T> others;         ///< 1, continued as σ^∓2/3
    Vec3<T> others_slope;   ///< ∂/∂r
  };

  /// What every quantity is made of.
  template <class T>
  struct Terms {
    Vec3<T> sigma;      ///< the stretches evaluated at
    Vec3<T> limited;    ///< c_i
    Vec3<T> inverse;    ///< 1/c_i
    Vec3<T> third;      ///< τ_i = ⅔ r_i
    Factors<T> first;   ///< of Ī1
    Factors<T> second;  ///< of Ī2
    T mu_10;            ///< μ10 V^(−2/3), V = c_1c_2c_3
    T mu_01;            ///< μ01 V^(2/3)
    T volume_log;       ///< L
  };

  EVERT_ALWAYS_INLINE double mu_10() const { return 0.5 * lame.mu * (1 - share_01); }
  EVERT_ALWAYS_INLINE double mu_01() const { return 0.5 * lame.mu * share_01; }

  /// The factors of the invariant whose powers are ±4/3 and ∓2/3, with `square` = c^±2; `sign` is the upper
  /// one.
  template <class T>
  EVERT_ALWAYS_INLINE static Factors<T> factors(const Vec3<T>& square, const Vec3<T>& third, double sign) {
    Factors<T> f;
    for (std::size_t i = 0; i < 3; ++i) {
      const T along = T(sign) * third[i];
      const T quadratic = along * along;
      f.own[i] = square[i] * (T(1.0) + T(2.0) * (along + quadratic));
      f.own_slope[i] = square[i] * (T(sign * (4.0 / 3)) * (T(1.0) + T(2.0) * along));
      f.own_curvature[i] = T(16.0 / 9) * square[i];
      f.others[i] = T(1.0) - along + T(0.5) * quadratic;
      f.others_slope[i] = T(-sign * (2.0 / 3)) * (T(1.0) - along);
    }
    return f;
  }

  template <class T>
  EVERT_ALWAYS_INLINE Terms<T> terms(const Vec3<T>& stretches) const {
    const auto [sigma, c, inverse, ratio, volume] = limited_terms(stretches, compression_limit, extension);
    const Vec3<T> third = T(2.0 / 3) * ratio;
    const T log_of_limited = log(volume);
    const T root = exp(T(-1.0 / 3) * log_of_limited);
    const Vec3<T> square{c[0] * c[0], c[1] * c[1], c[2] * c[2]};
    const Vec3<T> inverse_square{inverse[0] * inverse[0], inverse[1] * inverse[1], inverse[2] * inverse[2]};
    return {sigma,
            c,
            inverse,
            third,
            factors(square, third, 1),
            factors(inverse_square, third, -1),
            T(mu_10()) * (root * root),
            T(mu_01()) * (volume * root),
            log_of_limited + T(1.5) * (third[0] + third[1] + third[2])};
  }

  template <class T>
  EVERT_ALWAYS_INLINE static T sum_of_products(const Factors<T>& f) {
    return f.own[0] * f.others[1] * f.others[2] + f.others[0] * f.own[1] * f.others[2] +
           f.others[0] * f.others[1] * f.own[2];
  }

  /// own_j others_k + others_j own_k
  template <class T>
  EVERT_ALWAYS_INLINE static T of_others(const Factors<T>& f, std::size_t j, std::size_t k) {
    return f.own[j] * f.others[k] + f.others[j] * f.own[k];
  }

  /// ∂/∂r_i of sum_of_products.
  template <class T>
  EVERT_ALWAYS_INLINE static T first_slope(const Factors<T>& f, std::size_t i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    return f.own_slope[i] * (f.others[j] * f.others[k]) + f.others_slope[i] * of_others(f, j, k);
  }

  /// ∂²/∂r_i², with p² σ^p for the second derivative of every power.
  template <class T>
  EVERT_ALWAYS_INLINE static T curvature(const Factors<T>& f, std::size_t i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    return f.own_curvature[i] * (f.others[j] * f.others[k]) + T(4.0 / 9) * of_others(f, j, k);
  }

  /// ∂²/∂r_i∂r_j
  template <class T>
  EVERT_ALWAYS_INLINE static T second_slope(const Factors<T>& f, std::size_t i, std::size_t j,
                                            std::size_t k) {
    return (f.own_slope[i] * f.others_slope[j] + f.others_slope[i] * f.own_slope[j]) * f.others[k] +
           f.others_slope[i] * f.others_slope[j] * f.own[k];
  }

  /// Of two axes i and j: the divided differences of own, others, and of their slopes divided by c.
  template <class T>
  struct Differences {
    T own, others, own_stress, others_stress;
  };

  // What depends on c and what depends on r add up, since r is not 0 only where c = ε.

  template <class T>
  EVERT_ALWAYS_INLINE Differences<T> differences_of_first(const Terms<T>& at, const PairSlopes<T>& slopes,
                                                          std::size_t i, std::size_t j) const {
    const double e = compression_limit;
    const T rest = T(2.0 / 3 / e) * slopes.rest;  // (τ_i − τ_j)/(σ_i − σ_j)
    const T thirds = at.third[i] + at.third[j];
    return {(at.limited[i] + at.limited[j]) * slopes.limited + T(2 * e * e) * rest * (T(1.0) + thirds),
            rest * (T(0.5) * thirds - T(1.0)), T(4.0 / 3) * (slopes.limited + T(2 * e) * rest),
            T(2.0 / 3) * (at.inverse[i] * at.inverse[j] * slopes.limited + T(1 / e) * rest)};
  }

  template <class T>
  EVERT_ALWAYS_INLINE Differences<T> differences_of_second(const Terms<T>& at, const PairSlopes<T>& slopes,
                                                           std::size_t i, std::size_t j) const {
    const double e = compression_limit;
    const T rest = T(2.0 / 3 / e) * slopes.rest;
    const T thirds = at.third[i] + at.third[j];
    const T c_i = at.limited[i], c_j = at.limited[j];
    const T inverse = at.inverse[i] * at.inverse[j];
    const T square = inverse * inverse;
    return {T(2 / (e * e)) * rest * (thirds - T(1.0)) - (c_i + c_j) * square * slopes.limited,
            rest * (T(1.0) + T(0.5) * thirds),
            T(4.0 / 3) * ((c_i * c_i + c_i * c_j + c_j * c_j) * (square * inverse) * slopes.limited +
                          T(2 / (e * e * e)) * rest),
            T(2.0 / 3) * (T(1 / e) * rest - inverse * slopes.limited)};
  }

  /// (S_i − S_j)/(σ_i − σ_j) of S_i = first_slope_i / c_i.
  template <class T>
  EVERT_ALWAYS_INLINE static T shear(const Factors<T>& f, const Vec3<T>& inverse,
                                     const Differences<T>& differences, std::size_t i, std::size_t j,
                                     std::size_t k) {
    const T own_stress = f.own_slope[i] * inverse[i] + f.own_slope[j] * inverse[j];
    const T others_stress = f.others_slope[i] * inverse[i] + f.others_slope[j] * inverse[j];
    const T own = f.own[i] + f.own[j];
    const T others = f.others[i] + f.others[j];
    // a_i b_j − a_j b_i = ½ ((a_i − a_j)(b_i + b_j) − (b_i − b_j)(a_i + a_j))
    const T in_plane = differences.own_stress * others - differences.others * own_stress +
                       differences.others_stress * own - differences.own * others_stress;
    const T across = differences.others_stress * others - differences.others * others_stress;
    return T(0.5) * (in_plane * f.others[k] + across * f.own[k]);
  }
};

}  // namespace evert
