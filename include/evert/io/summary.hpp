#pragma once
#include "evert/core/index.hpp"
#include "evert/core/log.hpp"
#include "evert/sim/simulation.hpp"

#include <mpi.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace evert {

/// Wall seconds booked to each phase, over the ranks.
struct PhaseTimes {
  std::array<double, phase_count> mean{}, max{};
};
/// Collective. Of all ranks of `comm`, so far.
[[nodiscard]] PhaseTimes phase_times(MPI_Comm comm);

/// What a run leaves behind about itself. The application fills it.
struct RunSummary {
  std::string scene;    ///< its name
  std::string outcome;  ///< "finished", "interrupted" or what failed
  GlobalIndex nodes = 0;
  GlobalIndex cells = 0;
  std::int64_t steps = 0;
  double simulated_time = 0;           ///< [s]
  double wall_time = 0;                ///< [s]
  std::int64_t cg_iterations = 0;      ///< of the damping solves
  std::int64_t newton_iterations = 0;  ///< of the quasistatic solves (SNES)
  std::int64_t linear_iterations = 0;  ///< of the linear solves in those (KSP)
  std::int64_t frames = 0;
  GlobalIndex max_inverted_points = 0;
  double max_inverted_time = 0;  ///< [s] when there were most
  GlobalIndex quadrature_points = 0;
  Measurements final_state;
  std::vector<std::pair<std::string, double>> shape_errors;  ///< per body: rms distance to its rest shape [m]
  std::vector<std::pair<std::string, ObstacleImpulse>> obstacles;  ///< what each gave, since the start
  PhaseTimes phases;
  std::string cpu_level;  ///< instruction set of the kernels: x86-64-v2, -v3 or -v4
};

/// Collective. Writes summary.json in one step: the above, peak memory of each rank, number of ranks,
/// versions of evert, PETSc, MPI and HDF5. Throws UserError on all ranks when it cannot be written.
void write_summary(MPI_Comm comm, const std::string& path, const RunSummary& summary);

/// Largest resident size of this process so far [bytes].
[[nodiscard]] std::int64_t peak_memory();

}  // namespace evert
