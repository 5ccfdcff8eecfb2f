#pragma once
#include <mpi.h>

#include <ostream>
#include <span>
#include <string>

namespace evert {

/// Collective. `evert extremes ...`: runs the torture suite and grades every case; rank 0 reports to `out`.
/// Returns 0 when every case has kept its promise, 1 when not. Throws UserError on all ranks for bad usage
/// and for a file that cannot be written.
int extremes_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
