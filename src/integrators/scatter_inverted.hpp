#pragma once
#include "evert/contact/velocity_constraints.hpp"
#include "evert/integrators/system.hpp"

#include <cstdint>

namespace evert {

/// Collective. Moves the nodes of cells that are inverted at `x`, and of so many `rings` of cells around
/// them, at random by about the size of the cells, held components excepted. The same on any number of ranks;
/// `attempt` makes a difference. False where no cell of any rank is inverted; then nothing moves.
bool scatter_inverted(const System& system, std::span<const NodeConstraint> held, std::uint64_t attempt,
                      int rings, NodeField& x);

}  // namespace evert
