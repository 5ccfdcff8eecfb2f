#pragma once
#include "evert/scene/config.hpp"
#include "evert/sim/simulation.hpp"

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

/// The PETSc options of a scene and of the command line.
namespace evert {

/// Read by PETSc when it starts or ends: of no effect in a `petsc:` block, or worse.
[[nodiscard]] const std::vector<std::string>& process_options();

/// Puts the options of the scene's `petsc:` block into PETSc's database, those left out that are in there
/// already: the command line wins. The same on every rank. Call before anything reads options.
void apply_petsc_block(const SceneConfig& scene);

/// Throws UserError when an option stands without the value that it needs, which PETSc ignores in silence.
/// `command_line` are RunArguments::petsc. Not collective, the same on every rank.
void require_option_values(const SceneConfig& scene, std::span<const std::string> command_line);

/// The solvers that options may be for.
struct LiveSolvers {
  bool damping = false;
  bool explicit_damping = false;  ///< damped, without a solve
  bool quasistatic = false;
  bool projection = false;  ///< of a filter with compliant constraints
  bool stability = false;   ///< of evert stability, which no simulation has
};
/// Those that a simulation has.
[[nodiscard]] LiveSolvers solvers_of(const Simulation& simulation);

/// Collective. Throws UserError when the database holds an option that nothing has read, with the nearest one
/// that we know, unless `allow_unknown`; nothing reads the options of solves that the simulation does not
/// make. Call when everything that reads options exists.
void reject_unused_options(MPI_Comm comm, bool allow_unknown, const LiveSolvers& live);

}  // namespace evert
