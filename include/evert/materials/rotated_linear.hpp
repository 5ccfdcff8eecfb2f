#pragma once
#include "evert/materials/dilatation.hpp"
#include "evert/materials/lame.hpp"
#include "evert/math/vec3.hpp"

#include <string_view>

namespace evert {

/// Rotated linear ("corotational") elasticity: ψ = μ Σ(σ_i − 1)² + λ/2 (Σ(σ_i − 1))².  PHYSICS 3
///
/// Linear in the stretches everywhere, so there is nothing to extend: no compression limit.
struct RotatedLinear {
  static constexpr std::string_view name = "rotated_linear";

  Lame lame{};

  /// Energy density ψ(σ) [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    const T trace = strain[0] + strain[1] + strain[2];
    return T(lame.mu) * dot(strain, strain) + T(0.5 * lame.lambda) * trace * trace;
  }

  /// P̂ = ∂ψ/∂σ [Pa].
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    const T pressure = T(lame.lambda) * (strain[0] + strain[1] + strain[2]);
    return T(2 * lame.mu) * strain + Vec3<T>{pressure, pressure, pressure};
  }

  /// The trace of the strain.
  template <class T>
  EVERT_ALWAYS_INLINE Dilatation<T> dilatation(const Vec3<T>& sigma) const {
    const Vec3<T> strain = strains(sigma);
    return {strain[0] + strain[1] + strain[2], {T(1.0), T(1.0), T(1.0)}};
  }

  /// ∂²ψ/∂σ² [Pa], symmetric.
  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_derivative(const Vec3<T>& /*sigma*/) const {
    const T on = T(2 * lame.mu + lame.lambda);
    const T off = T(lame.lambda);
    return {{{{on, off, off}, {off, on, off}, {off, off, on}}}};
  }

  /// (P̂_i − P̂_j)/(σ_i − σ_j) [Pa] and its limit, of the pair without axis 0, 1, 2.
  template <class T>
  EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Vec3<T>& /*sigma*/) const {
    const T shear = T(2 * lame.mu);
    return {shear, shear, shear};
  }

 private:
  template <class T>
  EVERT_ALWAYS_INLINE static Vec3<T> strains(const Vec3<T>& sigma) {
    return {sigma[0] - T(1.0), sigma[1] - T(1.0), sigma[2] - T(1.0)};
  }
};

}  // namespace evert
