#pragma once
#include "evert/bench/kernel_cost.hpp"
#include "evert/bench/kernel_report.hpp"
#include "evert/core/log.hpp"
#include "evert/sim/simulation.hpp"

#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

/// `evert bench step`: what the time of the steps of a scene goes into.
namespace evert::bench {

/// Means over the ranks, of all steps.
struct PhaseProfile {
  std::string name;
  double seconds = 0;  ///< wall time
  double calls = 0;
  KernelCost work;  ///< nothing where it is not counted
};

struct StepProfile {
  GlobalIndex cells = 0;
  std::int64_t steps = 0;
  double processor_seconds = 0;  ///< summed over the ranks
  double wall_seconds = 0;
  std::vector<PhaseProfile> phases;  ///< the last is what no phase claims
  double flops = 0;                  ///< that a rank could do in a second
  double bytes = 0;                  ///< that a rank could move in a second
};

/// Watches the steps that are made between its construction and finish().
class StepProfiler {
 public:
  explicit StepProfiler(const Simulation& simulation);

  /// Collective. Measures what the machine could do, for `ceiling_seconds`.
  [[nodiscard]] StepProfile finish(double ceiling_seconds) const;

 private:
  const Simulation& simulation_;
  std::int64_t steps_;
  double processor_seconds_;
  double wall_seconds_;
  std::array<double, phase_count> seconds_;
  std::array<std::int64_t, phase_count> calls_;
};

/// The table; `cg_iterations` of all steps.
void print_profile(const StepProfile& profile, const std::string& scene, std::int64_t cg_iterations,
                   const Setting& setting, std::ostream& out);

}  // namespace evert::bench
