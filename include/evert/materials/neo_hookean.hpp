#pragma once
#include "evert/materials/compression_limit.hpp"
#include "evert/materials/dilatation.hpp"
#include "evert/materials/lame.hpp"
#include "evert/math/vec3.hpp"

#include <string_view>

namespace evert {

/// Compressible neo-Hookean solid: ψ = μ/2 (Σσ_i² − 3) − μ Σ ln σ_i + λ/2 (ln J)², P̂_i = μσ_i + (λ ln J −
/// μ)/σ_i. PHYSICS 3
///
/// Below the compression limit ε the *energy* is continued, so that the stress stays its exact gradient (the
/// axis-wise linearisation of the stress in paper A, section 6.1, is not: closed loops would gain or lose
/// work). With c = max(σ, ε) and d = σ − c ≤ 0 the two logarithms become
///
///   of shape:   −μ ln σ   →  −μ (ln c + d/c − d²/2c²)   its quadratic Taylor polynomial, C²
///   of volume:  ln J      →  L = Σ (ln c_i + d_i/c_i)   continued linearly, C¹
///
/// and P̂_i = μσ_i − μ(1/c_i − d_i/c_i²) + λL/c_i: continuous, linear in each stretch below ε with the
/// positive slope μ + (μ + λ)/ε², so that it drives every flat or inverted element back whatever its other
/// stretches are. No branches: above the limit d = 0.
struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  /// A material compressed to 30 % of its length is left exact; below, stiffness ceases to grow. At ν = 0.3
  /// the stiffness there is 14 times that at rest (stable step a quarter), at 0.2 it would be 35 times.
  static constexpr double default_compression_limit = 0.3;

  Lame lame{};
  double compression_limit = default_compression_limit;  ///< ε in (0, 1)
  Extension extension = Extension::linear;

  /// Energy density ψ(σ) [Pa]. With `clamp` that at the limited stretches, of which the stress is *not* the
  /// gradient.
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Vec3<T>& sigma) const {
    const Logarithms<T> at = logarithms(sigma);
    const T quadratic = dot(at.ratio, at.ratio);
    const T shape_log = at.volume_log - T(0.5) * quadratic;
    return T(0.5 * lame.mu) * (dot(at.sigma, at.sigma) - T(3.0)) - T(lame.mu) * shape_log +
           T(0.5 * lame.lambda) * at.volume_log * at.volume_log;
  }

  /// P̂ = ∂ψ/∂σ [Pa]; with `clamp` P̂ at the limited stretches.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    const Logarithms<T> at = logarithms(sigma);
    const T mu = T(lame.mu);
    const T pressure = T(lame.lambda) * at.volume_log - mu;
    const auto along = [&](int i) {
      return mu * at.sigma[i] + (pressure + mu * at.ratio[i]) * at.inverse[i];
    };
    return {along(0), along(1), along(2)};
  }

  /// L and 1/c.
  template <class T>
  EVERT_ALWAYS_INLINE Dilatation<T> dilatation(const Vec3<T>& sigma) const {
    const Logarithms<T> at = logarithms(sigma);
    return {at.volume_log, at.inverse};
  }

  /// ∂²ψ/∂σ² [Pa], symmetric; with `clamp` that at the limited stretches.
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_derivative(const Vec3<T>& sigma) const {
    const Logarithms<T> at = logarithms(sigma);
    const T mu = T(lame.mu);
    const T lambda = T(lame.lambda);
    // The slope of 1/c_i in the volume's term: none below the limit.
    const T bent = lambda * at.volume_log;
    const auto diagonal = [&](int i) {
      const T curvature = select(at.sigma[i] < T(compression_limit), mu, mu - bent);
      return mu + (curvature + lambda) * at.inverse[i] * at.inverse[i];
    };
    const T p01 = lambda * at.inverse[0] * at.inverse[1];
    const T p02 = lambda * at.inverse[0] * at.inverse[2];
    const T p12 = lambda * at.inverse[1] * at.inverse[2];
    return {{{{diagonal(0), p01, p02}, {p01, diagonal(1), p12}, {p02, p12, diagonal(2)}}}};
  }

  /// (P̂_i − P̂_j)/(σ_i − σ_j) [Pa] and its limit, of the pair without axis 0, 1, 2.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Vec3<T>& sigma) const {
    const Logarithms<T> at = logarithms(sigma);
    const T mu = T(lame.mu);
    const T pressure = T(lame.lambda) * at.volume_log - mu;
    const auto pair = [&](std::size_t i, std::size_t j) {
      const PairSlopes<T> slopes = pair_slopes(sigma[i], sigma[j], compression_limit, extension);
      return mu * (slopes.limited + slopes.rest) - pressure * at.inverse[i] * at.inverse[j] * slopes.limited +
             mu * T(1 / (compression_limit * compression_limit)) * slopes.rest;
    };
    return {pair(1, 2), pair(0, 2), pair(0, 1)};
  }

 private:
  /// What every quantity is made of.
  template <class T>
  struct Logarithms {
    Vec3<T> sigma;    ///< the stretches evaluated at
    Vec3<T> inverse;  ///< 1/c_i
    Vec3<T> ratio;    ///< d_i/c_i
    T volume_log;     ///< L, ln J above the limit
  };

  template <class T>
  EVERT_ALWAYS_INLINE Logarithms<T> logarithms(const Vec3<T>& stretches) const {
    const auto [sigma, c, inverse, ratio, volume] = limited_terms(stretches, compression_limit, extension);
    return {sigma, inverse, ratio, log(volume) + (ratio[0] + ratio[1] + ratio[2])};
  }
};

}  // namespace evert
