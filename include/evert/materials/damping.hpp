#pragma once

/// Damping: linear in v at fixed x, symmetric positive semidefinite.  paper A, section 6.2; PHYSICS 4
namespace evert {

enum class DampingModel {
  none,
  rotated,    ///< P̂ = β(Ḟ+Ḟᵀ) + α tr(Ḟ) I in the rotated frame: robust when flat
  objective,  ///< P = F(2βĖ + α tr(Ė) I): conserves angular momentum, vanishes when flat
};

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
