#pragma once
#include "evert/app/command_line.hpp"

#include <mpi.h>

#include <ostream>
#include <span>
#include <string>

namespace evert {

/// The arguments of `evert stability`: those of a run, and where a table of all elements goes.
struct StabilityArguments {
  RunArguments run;
  std::string table;  ///< -o file, or empty
};

/// Throws UserError as parse_run_arguments does, and for what only a run can do.
[[nodiscard]] StabilityArguments parse_stability_arguments(std::span<const std::string> arguments);

/// Collective. `evert stability SCENE.yaml`: the largest stable step of a scene, what different bounds say of
/// it, and which elements make it short, to `out` on rank 0. Returns the exit code; throws UserError.
int stability_command(MPI_Comm comm, const StabilityArguments& arguments, std::ostream& out);

/// What `evert stability -help` prints.
[[nodiscard]] std::string stability_usage();

}  // namespace evert
