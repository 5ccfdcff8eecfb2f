#pragma once
#include "evert/sim/definition.hpp"

#include <memory>
#include <vector>

/// What of a definition does not go together; UserError says what.
namespace evert {

/// The masses of a definition that can be. Contact, friction and schemes without solves know masses of nodes,
/// and what is at rest knows none.
[[nodiscard]] MassForm possible_mass(const SimulationDefinition& definition);

/// Takes the obstacles from a definition. The Euler schemes have no solve after the impacts, which alone
/// tells how hard a body is hit that gives way.
[[nodiscard]] std::vector<std::unique_ptr<Obstacle>> possible_obstacles(SimulationDefinition& definition);

}  // namespace evert
