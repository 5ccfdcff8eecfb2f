#pragma once
#include "evert/materials/compression_limit.hpp"
#include "evert/materials/lame.hpp"
#include "evert/math/vec3.hpp"

#include <string_view>

namespace evert {

/// St. Venant-Kirchhoff solid: ψ = μ ΣE_i² + λ/2 (ΣE_i)², E = (σ² − 1)/2, P̂_i = σ_i (2μE_i + λΣE_j).  PHYSICS
/// 3
///
/// It softens under compression (its stress turns round at σ = 1/√3 and vanishes when flat), so below the
/// limit ε the *strain* is continued linearly: with c = max(σ, ε), d = σ − c, E = (c² − 1)/2 + c d and P̂_i =
/// c_i (2μE_i + λΣE_j). ψ stays a potential, P̂ is continuous, and linear in each stretch below ε with slope
/// (2μ + λ)ε² > 0.
struct StVenantKirchhoff {
  static constexpr std::string_view name = "st_venant_kirchhoff";
  /// Just above 1/√3 = 0.577, where the uniaxial stress would turn round.
  static constexpr double default_compression_limit = 0.58;

  Lame lame{};
  double compression_limit = default_compression_limit;  ///< ε in (0, 1)
  Extension extension = Extension::linear;

  /// Energy density ψ(σ) [Pa]. With `clamp` that at the limited stretches, of which the stress is *not* the
  /// gradient.
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Vec3<T>& sigma) const {
    const Strains<T> at = strains(sigma);
    return T(lame.mu) * dot(at.strain, at.strain) + T(0.5 * lame.lambda) * at.trace * at.trace;
  }

  /// P̂ = ∂ψ/∂σ [Pa]; with `clamp` P̂ at the limited stretches.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    const Strains<T> at = strains(sigma);
    const auto along = [&](int i) { return at.slope[i] * second_piola_kirchhoff(at, i); };
    return {along(0), along(1), along(2)};
  }

  /// ∂²ψ/∂σ² [Pa], symmetric; with `clamp` that at the limited stretches.
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_derivative(const Vec3<T>& sigma) const {
    const Strains<T> at = strains(sigma);
    const T lambda = T(lame.lambda);
    const T modulus = T(2 * lame.mu + lame.lambda);
    const auto diagonal = [&](int i) {
      // E'' = 1 above the limit, 0 below.
      const T geometric = select(at.sigma[i] < T(compression_limit), T(0.0), second_piola_kirchhoff(at, i));
      return geometric + modulus * at.slope[i] * at.slope[i];
    };
    const T p01 = lambda * at.slope[0] * at.slope[1];
    const T p02 = lambda * at.slope[0] * at.slope[2];
    const T p12 = lambda * at.slope[1] * at.slope[2];
    return {{{{diagonal(0), p01, p02}, {p01, diagonal(1), p12}, {p02, p12, diagonal(2)}}}};
  }

  /// (P̂_i − P̂_j)/(σ_i − σ_j) [Pa] and its limit, of the pair without axis 0, 1, 2.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Vec3<T>& sigma) const {
    const Strains<T> at = strains(sigma);
    const auto pair = [&](std::size_t i, std::size_t j) {
      const PairSlopes<T> slopes = pair_slopes(sigma[i], sigma[j], compression_limit, extension);
      const T mean = T(0.5) * (at.slope[i] + at.slope[j]);
      const T strain_slope = mean * slopes.limited + T(compression_limit) * slopes.rest;
      const T mean_stress = T(lame.mu) * (at.strain[i] + at.strain[j]) + T(lame.lambda) * at.trace;
      return T(2 * lame.mu) * mean * strain_slope + mean_stress * slopes.limited;
    };
    return {pair(1, 2), pair(0, 2), pair(0, 1)};
  }

 private:
  /// The Green strain of each axis.
  template <class T>
  struct Strains {
    Vec3<T> sigma;   ///< the stretches evaluated at
    Vec3<T> slope;   ///< c_i = dE_i/dσ_i
    Vec3<T> strain;  ///< E_i
    T trace;         ///< ΣE_i
  };

  template <class T>
  EVERT_ALWAYS_INLINE Strains<T> strains(const Vec3<T>& stretches) const {
    const Vec3<T> sigma = evaluated_stretches(stretches, compression_limit, extension);
    const Vec3<T> c = limited_stretches(sigma, compression_limit);
    const auto strain_along = [&](int i) {
      return T(0.5) * (c[i] * c[i] - T(1.0)) + c[i] * (sigma[i] - c[i]);
    };
    const Vec3<T> strain{strain_along(0), strain_along(1), strain_along(2)};
    return {sigma, c, strain, strain[0] + strain[1] + strain[2]};
  }

  template <class T>
  EVERT_ALWAYS_INLINE T second_piola_kirchhoff(const Strains<T>& at, int i) const {
    return T(2 * lame.mu) * at.strain[i] + T(lame.lambda) * at.trace;
  }
};

}  // namespace evert
