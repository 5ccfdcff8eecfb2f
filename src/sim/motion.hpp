#pragma once
#include "evert/integrators/system.hpp"

namespace evert {

/// What moves, this rank's share.
struct Motion {
  double kinetic_energy = 0;  ///< [J]
  Vec3d momentum{};           ///< [N s]
  Vec3d angular_momentum{};   ///< about the origin [N m s]
};

/// Collective. Of the nodes, with lumped masses or consistent ones.
[[nodiscard]] Motion motion_of(const System& system);

}  // namespace evert
