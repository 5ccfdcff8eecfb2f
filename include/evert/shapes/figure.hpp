#pragma once
#include "evert/shapes/combined.hpp"

namespace evert {

/// A figure of ellipsoids and capsules that stands upright, arms outstretched along x, face towards z: thin
/// limbs, spread fingers, feet, nose and ears, for tests of contact that are hard on a body. The soles are at
/// −height/2, the top of the head at height/2 [m]. Its thinnest parts, the fingers, are height/60 thick.
/// Throws UserError unless height is positive and finite.
[[nodiscard]] Solid figure(double height);

}  // namespace evert
