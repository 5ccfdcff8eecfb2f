#pragma once
#include "evert/materials/lame.hpp"
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <string_view>

namespace evert {

/// Stable neo-Hookean solid (Smith, de Goes, Kim 2018): ψ = μ'/2 (I − 3 − ln((I + 1)/4)) + λ'/2 (J − 1)² − ¾
/// μ' (J − 1), I = Σσ_i², J = σ_1σ_2σ_3, with μ' = 4/3 μ and λ' = λ + 5/6 μ so that λ, μ are those of small
/// strains.
///
/// Finite and smooth everywhere: no compression limit. An element that lies exactly in a line or a point
/// feels no force across it, since its volume has no slope there.
struct StableNeoHookean {
  static constexpr std::string_view name = "stable_neo_hookean";

  Lame lame{};

  /// Energy density ψ(σ) [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Vec3<T>& sigma) const {
    const T squares = dot(sigma, sigma);
    const T growth = sigma[0] * sigma[1] * sigma[2] - T(1.0);
    return T(0.5 * shear()) * (squares - T(3.0) - log(T(0.25) * (squares + T(1.0)))) +
           (T(0.5 * bulk()) * growth - T(0.75 * shear())) * growth;
  }

  /// P̂ = ∂ψ/∂σ [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    return at.stiffness * sigma + at.pressure * at.slope;
  }

  /// ∂²ψ/∂σ² [Pa], symmetric.
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_derivative(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    const T shape = T(2 * shear()) * at.weight * at.weight;
    const auto entry = [&](std::size_t i, std::size_t j) {
      return shape * sigma[i] * sigma[j] + T(bulk()) * at.slope[i] * at.slope[j];
    };
    const T p01 = entry(0, 1) + at.pressure * sigma[2];
    const T p02 = entry(0, 2) + at.pressure * sigma[1];
    const T p12 = entry(1, 2) + at.pressure * sigma[0];
    return {{{{at.stiffness + entry(0, 0), p01, p02},
              {p01, at.stiffness + entry(1, 1), p12},
              {p02, p12, at.stiffness + entry(2, 2)}}}};
  }

  /// (P̂_i − P̂_j)/(σ_i − σ_j) [Pa] and its limit, of the pair without axis 0, 1, 2.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    const Vec3<T> all{at.stiffness, at.stiffness, at.stiffness};
    return all - at.pressure * sigma;
  }

  /// (P̂_i + P̂_j)/(σ_i + σ_j) [Pa] and its limit: finite, since ψ is smooth in F.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> spin_moduli(const Vec3<T>& sigma) const {
    const Terms<T> at = terms(sigma);
    const Vec3<T> all{at.stiffness, at.stiffness, at.stiffness};
    return all + at.pressure * sigma;
  }

 private:
  /// What stress and derivative share.
  template <class T>
  struct Terms {
    Vec3<T> slope;  ///< ∂J/∂σ_i
    T weight;       ///< 1/(I + 1)
    T stiffness;    ///< μ' (1 − 1/(I + 1))
    T pressure;     ///< λ' (J − 1) − ¾ μ'
  };

  template <class T>
  EVERT_ALWAYS_INLINE Terms<T> terms(const Vec3<T>& sigma) const {
    const T weight = T(1.0) / (dot(sigma, sigma) + T(1.0));
    const T growth = sigma[0] * sigma[1] * sigma[2] - T(1.0);
    return {{sigma[1] * sigma[2], sigma[0] * sigma[2], sigma[0] * sigma[1]},
            weight,
            T(shear()) * (T(1.0) - weight),
            T(bulk()) * growth - T(0.75 * shear())};
  }

  EVERT_ALWAYS_INLINE double shear() const { return 4.0 / 3 * lame.mu; }
  EVERT_ALWAYS_INLINE double bulk() const { return lame.lambda + 5.0 / 6 * lame.mu; }
};

}  // namespace evert
