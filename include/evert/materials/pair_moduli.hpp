#pragma once
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

/// The moduli of pairs of axes in ∂P/∂F of isotropic models: in the frames of U and V, a change of F off the
/// diagonal meets (P̂_i − P̂_j)/(σ_i − σ_j) with its symmetric part and (P̂_i + P̂_j)/(σ_i + σ_j) with its skew
/// part. Component k is of the pair without axis k.
namespace evert {

/// The model offers (P̂_i − P̂_j)/(σ_i − σ_j) as `shear_moduli(sigma)`, exact for equal stretches, too.
template <class Model>
concept HasShearModuli = requires(const Model& model, const Vec3d& sigma) {
  model.shear_moduli(sigma);
};

/// The model offers (P̂_i + P̂_j)/(σ_i + σ_j) as `spin_moduli(sigma)`: it is smooth in F where the axis of
/// inversion switches.
template <class Model>
concept HasSpinModuli = requires(const Model& model, const Vec3d& sigma) {
  model.spin_moduli(sigma);
};

/// Axes closer than this have the limit of the divided difference, in models that do not offer their own.
template <class Scalar>
inline constexpr Scalar equal_stretches = Scalar(1e-5);
/// Here the rounding of the stresses, 1e-7 of the modulus, and the error of the limit are alike.
template <>
inline constexpr float equal_stretches<float> = 1e-3F;

/// (P̂_i − P̂_j)/(σ_i − σ_j) and its limit, with `stress` and `derivative` of the model at `sigma`.
template <Real T, class Model>
EVERT_ALWAYS_INLINE Vec3<T> shear_moduli(const Model& model, const Vec3<T>& sigma, const Vec3<T>& stress,
                                         const Mat3<T>& derivative) {
  if constexpr (HasShearModuli<Model>) {
    return model.shear_moduli(sigma);
  } else {
    const auto pair = [&](std::size_t i, std::size_t j) {
      const T difference = sigma[i] - sigma[j];
      const auto equal = abs(difference) < T(equal_stretches<scalar_t<T>>);
      const T limit = T(0.5) * (derivative(i, i) + derivative(j, j)) - derivative(i, j);
      return select(equal, limit, (stress[i] - stress[j]) / select(equal, T(1.0), difference));
    };
    return {pair(1, 2), pair(0, 2), pair(0, 1)};
  }
}

/// (P̂_i + P̂_j)/(σ_i + σ_j). Most models are not smooth where the inverted axis switches, at σ_i + σ_j = 0:
/// the quotient grows without bound there, and is not followed below a sum of `smallest_sum` ≥ 0.
template <Real T, class Model>
EVERT_ALWAYS_INLINE Vec3<T> spin_moduli(const Model& model, const Vec3<T>& sigma, const Vec3<T>& stress,
                                        double smallest_sum) {
  if constexpr (HasSpinModuli<Model>) {
    return model.spin_moduli(sigma);
  } else {
    const auto pair = [&](std::size_t i, std::size_t j) {
      return (stress[i] + stress[j]) / max(sigma[i] + sigma[j], T(smallest_sum));
    };
    return {pair(1, 2), pair(0, 2), pair(0, 1)};
  }
}

}  // namespace evert
