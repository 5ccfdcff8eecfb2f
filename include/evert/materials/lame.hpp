#pragma once
#include <algorithm>

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

  /// `shear_modulus` μ and `bulk_modulus` κ = λ + 2μ/3 [Pa].
  static constexpr Lame from_shear_bulk(double shear_modulus, double bulk_modulus) {
    return {bulk_modulus - 2.0 / 3 * shear_modulus, shear_modulus};
  }

  /// With a little resistance to shear where there is none, as in a liquid: what the stiffness of a state is
  /// compared with. A body without any stiffness stays one.
  [[nodiscard]] constexpr Lame regular() const { return {lambda, std::max(mu, 1e-5 * lambda)}; }

  [[nodiscard]] constexpr double bulk_modulus() const { return lambda + 2.0 / 3 * mu; }
};

/// What a model does below its compression limit.  PHYSICS 3
enum class Extension {
  linear,  ///< the energy is continued so that stress stays its exact gradient and always acts to uninvert
  clamp,   ///< stress evaluated at max(σ, limit); C⁰, what the common FEM library does
};

}  // namespace evert
