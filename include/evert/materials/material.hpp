#pragma once
#include "evert/materials/mooney_rivlin.hpp"
#include "evert/materials/muscle.hpp"
#include "evert/materials/neo_hookean.hpp"
#include "evert/materials/rotated_linear.hpp"
#include "evert/materials/spline.hpp"
#include "evert/materials/st_venant_kirchhoff.hpp"
#include "evert/materials/stable_neo_hookean.hpp"
#include "evert/materials/tendon.hpp"

#include <variant>

namespace evert {

/// Every elastic model. Dispatched on once per element block, never per point.
using Material = std::variant<RotatedLinear, NeoHookean, StVenantKirchhoff, MooneyRivlin, Spline,
                              StableNeoHookean, Muscle, Tendon>;

/// True of models whose fibres need a direction at every point.
[[nodiscard]] inline bool has_fibres(const Material& material) {
  return std::visit([]<class Model>(const Model&) { return HasFibres<Model>; }, material);
}

/// Sets the activation of muscle, in [0, 1]; other models have none.
inline void set_activation(Material& material, double activation) {
  if (auto* muscle = std::get_if<Muscle>(&material)) muscle->activation = activation;
}

}  // namespace evert
