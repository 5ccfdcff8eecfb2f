#include "evert/integrators/time_step.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace evert {
double TimeStepControl::suggest(System& system, StabilityLimit limit) {
  system.elastic.halo().begin_update(system.v);
  system.elastic.halo().end_update(system.v);
  const bool estimate = age_ == never || age_ >= steps_between_estimates;
  // One reduction for both limits, as a minimum.
  std::array<double, 2> limits{std::numeric_limits<double>::infinity(), stable_};
  const double rate = system.elastic.max_strain_rate(system.x, system.v);
  if (rate > 0) limits[0] = options_.max_strain_increment / rate;
  if (estimate) limits[1] = limit(system);
  MPI_Allreduce(MPI_IN_PLACE, limits.data(), 2, MPI_DOUBLE, MPI_MIN, system.mesh.comm);
  stable_ = limits[1];
  age_ = estimate ? 1 : age_ + 1;
  return std::min(limits[0], options_.safety * stable_);
}

void TimeStepControl::restore(const State& state) {
  stable_ = state.stable;
  age_ = static_cast<int>(state.age);
}

}  // namespace evert
