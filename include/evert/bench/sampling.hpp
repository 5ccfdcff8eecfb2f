#pragma once
#include <mpi.h>

#include <functional>
#include <span>
#include <vector>

/// Timing of small pieces of work on a machine that does other things too.
namespace evert::bench {

/// A piece of work that may be repeated as often as one likes: it leaves the state it starts from.
struct Workload {
  double items = 0;           ///< what one call of `run` gets done, summed over the ranks
  std::function<void()> run;  ///< collective
};

/// Items per second, summed over the ranks.
struct Rate {
  double best = 0;
  double median = 0;
};

struct Measurement {
  std::vector<Rate> rates;  ///< parallel to the workloads
  int rounds = 0;           ///< samples of each
};

/// Collective. Takes short samples of the workloads in turn, one of each a round, so that whatever makes the
/// machine faster or slower meets all of them alike, until `seconds` per workload are spent. A sample is as
/// many calls as take a few milliseconds, at least one; its time is the thread's processor time, in which
/// what other processes take is not, and of this the largest over the ranks.
[[nodiscard]] Measurement measure(MPI_Comm comm, std::span<const Workload> workloads, double seconds);

}  // namespace evert::bench
