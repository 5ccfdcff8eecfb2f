#pragma once
#include <mpi.h>

#include <ostream>
#include <span>
#include <string>

namespace evert {

/// Collective. `evert bench kernels ...`: measures Evert on this machine. `arguments` are those after `evert
/// bench`, the same on every rank; rank 0 reports to `out`. Returns the exit code 0. Throws UserError on all
/// ranks for bad usage and for a file that cannot be written.
int bench_command(MPI_Comm comm, std::span<const std::string> arguments, std::ostream& out);

}  // namespace evert
