#pragma once
#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

/// Damping: linear in v at fixed x, symmetric positive semidefinite.  paper A, section 6.2; PHYSICS 4
namespace evert {

enum class DampingModel {
  none,
  rotated,    ///< P̂ = β(Ḟ+Ḟᵀ) + α tr(Ḟ) I in the rotated frame: robust when flat
  objective,  ///< P = F(2βĖ + α tr(Ė) I): conserves angular momentum, vanishes when flat
  blended,    ///< objective above blend_end, rotated where flat or inverted, smooth between
};

/// `blended` is `objective` to the last bit where all stretches are at least blend_end, and `rotated` where
/// one is blend_begin or less. At blend_end itself what is left of the damping along the stretch is its
/// square, a quarter of that at rest; below it grows again.
inline constexpr double blend_begin = 0.1;
inline constexpr double blend_end = 0.5;

/// How far a point is from flat or inverted, by its principal stretches: 0 is `objective`, 1 is `rotated`.
/// Once continuously differentiable. A product over the stretches and no function of the smallest alone,
/// which has a kink where two are equal.
template <class T>
EVERT_ALWAYS_INLINE T rotated_share(const Vec3<T>& sigma) {
  T objective_share = T(1.0);
  for (const T& stretch : sigma.components) {
    const T s = min(max((stretch - T(blend_begin)) * T(1 / (blend_end - blend_begin)), T(0.0)), T(1.0));
    objective_share *= s * s * (T(3.0) - T(2.0) * s);
  }
  return T(1.0) - objective_share;
}

/// Coefficients of one block of elements [Pa s].
struct Damping {
  DampingModel model = DampingModel::none;
  double alpha = 0;  ///< volumetric
  double beta = 0;   ///< deviatoric

  /// α = τλ, β = τμ for a stiffness-proportional time τ [s].
  static constexpr Damping stiffness_proportional(DampingModel model, double time, double lambda, double mu) {
    return {model, time * lambda, time * mu};
  }
};

}  // namespace evert
