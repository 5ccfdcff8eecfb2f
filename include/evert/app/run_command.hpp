#pragma once
#include "evert/app/command_line.hpp"

#include <mpi.h>

namespace evert {

/// Collective. `evert run`: builds the scene, runs it and writes what it asks for. Returns the exit code: 0
/// done, 130 interrupted after writing a checkpoint. Throws UserError (2) and SimulationError (3).
int run_command(MPI_Comm comm, const RunArguments& arguments);

}  // namespace evert
