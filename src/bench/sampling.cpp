#include "evert/bench/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace evert::bench {
namespace {

/// Long against the clock's resolution and a cold start, short against the drift of the machine.
constexpr double sample_seconds = 5e-3;
/// A median of fewer says little; takes precedence over the time allowed.
constexpr int fewest_rounds = 5;

/// Processor time of this thread.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Collective: every rank gets the same number and thus takes the same decisions.
double time_of(MPI_Comm comm, const Workload& workload, int repetitions) {
  MPI_Barrier(comm);
  const double begin = thread_seconds();
  for (int i = 0; i < repetitions; ++i) workload.run();
  double seconds = thread_seconds() - begin;
  MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_MAX, comm);
  return seconds;
}

/// Calls that fill a sample. Doubles until they are long enough to be timed; the first call of all warms up.
int repetitions_of(MPI_Comm comm, const Workload& workload) {
  workload.run();
  int repetitions = 1;
  for (;;) {
    const double seconds = time_of(comm, workload, repetitions);
    if (seconds > 0.5 * sample_seconds)
      return std::max(1, static_cast<int>(std::lround(repetitions * sample_seconds / seconds)));
    repetitions *= 2;
  }
}

double median_of_sorted(std::span<const double> values) {
  const auto half = values.size() / 2;
  return values.size() % 2 != 0 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

Measurement measure(MPI_Comm comm, std::span<const Workload> workloads, double seconds) {
  std::vector<int> repetitions;
  for (const auto& workload : workloads) repetitions.push_back(repetitions_of(comm, workload));

  std::vector<std::vector<double>> samples(workloads.size());  // seconds a call
  const double allowed = seconds * static_cast<double>(workloads.size());
  Measurement result;
  for (double spent = 0; spent < allowed || result.rounds < fewest_rounds; ++result.rounds) {
    for (std::size_t i = 0; i < workloads.size(); ++i) {
      const double sample = time_of(comm, workloads[i], repetitions[i]);
      samples[i].push_back(sample / repetitions[i]);
      spent += sample;
    }
  }
  for (std::size_t i = 0; i < workloads.size(); ++i) {
    std::ranges::sort(samples[i]);
    result.rates.push_back(
        {workloads[i].items / samples[i].front(), workloads[i].items / median_of_sorted(samples[i])});
  }
  return result;
}

}  // namespace evert::bench
