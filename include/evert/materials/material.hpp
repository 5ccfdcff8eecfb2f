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
using Material =
    std::variant<RotatedLinear, NeoHookean, StVenantKirchhoff, MooneyRivlin, Spline, StableNeoHookean>;

}  // namespace evert
