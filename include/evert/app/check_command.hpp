#pragma once
#include <ostream>
#include <span>
#include <string>

namespace evert {

/// `evert check scene.yaml [-set path=value] [PETSc options]`: validates a scene without running it, and
/// prints what would be built and what it would cost: bodies, cells, materials, obstacles, constraints,
/// events, time step, number of steps and frames, memory. Builds the simulation on the calling rank alone and
/// makes two steps to time them. Not collective: for one rank. Returns the exit code 0. Throws UserError for
/// whatever a run would refuse.
int check_command(std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
