#include "evert/bench/step_profile.hpp"

#include "evert/bench/sampling.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/formatted.hpp"

#include "kernel_subjects.hpp"
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <numeric>

namespace evert::bench {
namespace {

/// Of all threads of this process [s].
double processor_time() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double sum_over_ranks(MPI_Comm comm, double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, comm);
  return value;
}

/// What one call of a phase takes on this rank, in full precision; nothing where it is not counted.
KernelCost cost_of_call(Phase phase, const Simulation& simulation) {
  KernelCost cost;
  if (phase != Phase::force && phase != Phase::damping_apply) return cost;
  for (const auto& block : simulation.elastic().blocks()) {
    if (block == nullptr || (phase == Phase::damping_apply && !block->damped())) continue;
    const KernelCost of_point = phase == Phase::force
                                    ? force_cost(block->type(), block->material(), block->damping().model)
                                    : damping_cost(block->type(), block->damping().model);
    const double points = static_cast<double>(block->cells()) * quadrature_points(block->type());
    cost.flops += of_point.flops * points;
    cost.divisions += of_point.divisions * points;
    cost.bytes += of_point.bytes * points;
  }
  cost.bytes += nodal_bytes * static_cast<double>(simulation.mesh().local_nodes());
  return cost;
}

template <class... Values>
void put(std::ostream& out, const char* format, Values... values) {
  out << formatted(format, values...);
}

void print_rate(double work, double seconds, double ceiling, std::ostream& out) {
  put(out, "%10.1f (%2.0f %%)", work / seconds / 1e9, 100 * work / seconds / ceiling);
}

}  // namespace

StepProfiler::StepProfiler(const Simulation& simulation)
    : simulation_(simulation),
      steps_(simulation.steps()),
      processor_seconds_(processor_time()),
      wall_seconds_(MPI_Wtime()),
      seconds_(phase_seconds()),
      calls_(phase_calls()) {}

StepProfile StepProfiler::finish(double ceiling_seconds) const {
  const MPI_Comm comm = simulation_.mesh().comm;
  const double ranks = size_of(comm);
  StepProfile profile{.cells = simulation_.mesh().total_cells,
                      .steps = simulation_.steps() - steps_,
                      .processor_seconds = sum_over_ranks(comm, processor_time() - processor_seconds_),
                      .wall_seconds = sum_over_ranks(comm, MPI_Wtime() - wall_seconds_) / ranks,
                      .phases = {}};
  double claimed = 0;
  for (std::size_t i = 0; i < phase_count; ++i) {
    const auto phase = static_cast<Phase>(i);
    PhaseProfile entry{std::string(name_of(phase)), phase_seconds()[i] - seconds_[i],
                       static_cast<double>(phase_calls()[i] - calls_[i]), cost_of_call(phase, simulation_)};
    entry.seconds = sum_over_ranks(comm, entry.seconds) / ranks;
    entry.work.flops = sum_over_ranks(comm, entry.work.flops * entry.calls) / ranks;
    entry.work.bytes = sum_over_ranks(comm, entry.work.bytes * entry.calls) / ranks;
    claimed += entry.seconds;
    profile.phases.push_back(entry);
  }
  profile.phases.push_back({"the rest", profile.wall_seconds - claimed, 0, {}});

  CeilingSubject ceilings(simulation_.elastic().memory());
  const std::array<Workload, 2> workloads{{{CeilingSubject::flops(), [&] { ceilings.multiply_add(); }},
                                           {ceilings.triad_bytes(), [&] { ceilings.triad(); }}}};
  const auto measured = measure(comm, workloads, ceiling_seconds);
  profile.flops = measured.rates[0].median;
  profile.bytes = measured.rates[1].median;
  return profile;
}

void print_profile(const StepProfile& profile, const std::string& scene, std::int64_t cg_iterations,
                   const Setting& setting, std::ostream& out) {
  const auto steps = static_cast<double>(profile.steps);
  out << "evert bench step: " << scene << ", " << profile.cells << " cells, " << setting.ranks
      << (setting.ranks == 1 ? " rank" : " ranks") << " on " << setting.machine << ", kernels "
      << setting.cpu_level << ", " << setting.date << "\n\n";
  put(out, "%lld steps, %.1f CG iterations a step, %.3g s of processor time: %.3f us per cell and step\n\n",
      static_cast<long long>(profile.steps), static_cast<double>(cg_iterations) / steps,
      profile.processor_seconds,
      1e6 * profile.processor_seconds / steps / static_cast<double>(profile.cells));
  put(out, "%-16s%8s%12s%14s%17s%17s\n", "", "share", "us a step", "calls a step", "Gflop/s", "GB/s");
  for (const auto& phase : profile.phases) {
    if (phase.seconds <= 0) continue;
    put(out, "%-16s%6.1f %%%12.1f", phase.name.c_str(), 100 * phase.seconds / profile.wall_seconds,
        1e6 * phase.seconds / steps);
    if (phase.calls > 0) put(out, "%14.2f", phase.calls / steps);
    if (phase.work.flops > 0) {
      print_rate(phase.work.flops, phase.seconds, profile.flops, out);
      print_rate(phase.work.bytes, phase.seconds, profile.bytes, out);
    }
    out << '\n';
  }
  put(out, "\nin brackets: of what a rank could do, %.0f Gflop/s and %.1f GB/s\n", profile.flops / 1e9,
      profile.bytes / 1e9);
}

}  // namespace evert::bench
