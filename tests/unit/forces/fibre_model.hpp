#pragma once
#include "evert/materials/neo_hookean.hpp"
#include "evert/math/svd3.hpp"

namespace evert::test {

/// A toy that the library does not know: neo-Hookean with fibres along `fibre` that resist any change of
/// length, ψ = ψ_nh(σ) + k/4 (I₄ − 1)², I₄ = |F a|² = Σ σ_i² (Vᵀa)_i². Its P is that of the matrix plus
/// k (I₄ − 1) F a aᵀ, so P̂ gains k (I₄ − 1) (F̂ Vᵀa)(Vᵀa)ᵀ, which is neither diagonal nor symmetric.
struct FibreModel {
  NeoHookean matrix;
  double stiffness;  ///< k [Pa]
  Vec3d fibre;       ///< a, a unit vector at rest

  template <class T>
  EVERT_ALWAYS_INLINE T energy(const Svd3<T>& svd) const {
    const Fibre<T> at = stretched(svd);
    const T excess = dot(at.now, at.now) - T(1.0);
    return matrix.energy(svd.sigma) + T(0.25 * stiffness) * excess * excess;
  }

  template <class T>
  EVERT_ALWAYS_INLINE Mat3<T> stress_in_frames(const Svd3<T>& svd) const {
    const Fibre<T> at = stretched(svd);
    const T tension = T(stiffness) * (dot(at.now, at.now) - T(1.0));
    return diagonal(matrix.principal_stress(svd.sigma)) + tension * outer(at.now, at.rest);
  }

 private:
  template <class T>
  struct Fibre {
    Vec3<T> rest;  ///< Vᵀa
    Vec3<T> now;   ///< Uᵀ F a
  };

  template <class T>
  EVERT_ALWAYS_INLINE Fibre<T> stretched(const Svd3<T>& svd) const {
    const Vec3<T> rest = transpose_times(svd.v, Vec3<T>{T(fibre[0]), T(fibre[1]), T(fibre[2])});
    return {rest, {svd.sigma[0] * rest[0], svd.sigma[1] * rest[1], svd.sigma[2] * rest[2]}};
  }
};

}  // namespace evert::test
