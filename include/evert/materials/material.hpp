#pragma once
#include "evert/materials/neo_hookean.hpp"
#include "evert/materials/rotated_linear.hpp"
#include "evert/materials/st_venant_kirchhoff.hpp"

#include <variant>

namespace evert {

/// Every elastic model. Dispatched on once per element block, never per point.
using Material = std::variant<RotatedLinear, NeoHookean, StVenantKirchhoff>;

}  // namespace evert
