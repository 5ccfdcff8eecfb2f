#pragma once

namespace evert {

/// Lamé parameters of an isotropic material [Pa].
struct Lame {
  double lambda = 0;
  double mu = 0;

  /// `youngs_modulus` ≥ 0 [Pa], `poissons_ratio` in (−1, 0.5).
  static constexpr Lame from_young_poisson(double youngs_modulus, double poissons_ratio) {
    return {youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio)),
            youngs_modulus / (2 * (1 + poissons_ratio))};
  }
};

/// What a model does below its compression limit.  PHYSICS 3
enum class Extension {
  linear,  ///< the energy is continued so that stress stays its exact gradient and always acts to uninvert
  clamp,   ///< stress evaluated at max(σ, limit); C⁰, what the common FEM library does
};

}  // namespace evert
