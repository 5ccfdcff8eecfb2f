#include "evert/scene/material.hpp"

namespace evert {
namespace {

MooneyRivlin mooney_rivlin_of(const MaterialConfig& config) {
  const double limit = config.compression_limit.value_or(MooneyRivlin::default_compression_limit);
  if (config.mu_10)
    return MooneyRivlin::from_constants(*config.mu_10, *config.mu_01, *config.bulk_modulus, limit,
                                        config.extension);
  return {lame_of(config), config.mu_01_share.value_or(MooneyRivlin::default_share_01), limit,
          config.extension};
}

Spline spline_of(const MaterialConfig& config) {
  return {lame_of(config), config.compression_limit.value_or(Spline::default_compression_limit),
          config.elongation_limit.value_or(Spline::default_elongation_limit),
          config.compression_stiffening.value_or(Spline::default_stiffening),
          config.elongation_stiffening.value_or(Spline::default_stiffening)};
}

/// What muscle and tendon have in common.
template <class Model>
Model fibrous_of(const MaterialConfig& config) {
  const PassiveCurve curve;
  Model model{.lame = lame_of(config),
              .share_01 = mooney_rivlin_of(config).share_01,
              .compression_limit = config.compression_limit.value_or(Model::default_compression_limit),
              .peak_stress = config.peak_stress.value_or(Model::default_peak_stress)};
  model.passive = {config.passive_factor.value_or(curve.factor),
                   config.passive_exponent.value_or(curve.exponent),
                   config.passive_limit.value_or(curve.linear_from)};
  return model;
}

Muscle muscle_of(const MaterialConfig& config) {
  auto muscle = fibrous_of<Muscle>(config);
  muscle.active.width = config.active_width.value_or(muscle.active.width);
  return muscle;
}

}  // namespace

Lame lame_of(const MaterialConfig& config) {
  if (config.mu_10)
    return MooneyRivlin::from_constants(*config.mu_10, *config.mu_01, *config.bulk_modulus).lame;
  if (config.mu) return {*config.lambda, *config.mu};
  return Lame::from_young_poisson(*config.youngs_modulus, *config.poissons_ratio);
}

bool has_fibres(MaterialModel model) {
  return model == MaterialModel::muscle || model == MaterialModel::tendon;
}

Material material_of(const MaterialConfig& config) {
  const auto limit_or = [&](double own) { return config.compression_limit.value_or(own); };
  switch (config.model) {
    case MaterialModel::rotated_linear:
      return RotatedLinear{lame_of(config)};
    case MaterialModel::st_venant_kirchhoff:
      return StVenantKirchhoff{lame_of(config), limit_or(StVenantKirchhoff::default_compression_limit),
                               config.extension};
    case MaterialModel::mooney_rivlin:
      return mooney_rivlin_of(config);
    case MaterialModel::spline:
      return spline_of(config);
    case MaterialModel::stable_neo_hookean:
      return StableNeoHookean{lame_of(config)};
    case MaterialModel::muscle:
      return muscle_of(config);
    case MaterialModel::tendon:
      return fibrous_of<Tendon>(config);
    case MaterialModel::neo_hookean:
      break;
  }
  return NeoHookean{lame_of(config), limit_or(NeoHookean::default_compression_limit), config.extension};
}

}  // namespace evert
