#pragma once
#include "evert/core/index.hpp"

#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

/// What a long run tells while it goes on.
namespace evert {

struct ProgressState {
  double time = 0;  ///< [s] simulated
  std::int64_t steps = 0;
  GlobalIndex inverted = 0;        ///< inverted elements, by quadrature points
  std::int64_t cg_iterations = 0;  ///< since the start of the run
};

enum class ProgressStyle {
  silent,
  lines,      ///< a line every few seconds, for files and pipes
  rewriting,  ///< one line that is written over, for terminals
};

/// The style for the standard output. Sees through mpirun, which gives its children a terminal of its own
/// making even when its own output goes to a file.
[[nodiscard]] ProgressStyle progress_style(bool quiet);

/// Shows the progress of a run from `start` to `end` [s]. Rank 0 writes.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// Collective: the style of rank 0 counts. `begin` is what a restart starts from.
  Progress(MPI_Comm comm, ProgressStyle style, const ProgressState& begin, double end,
           std::FILE* out = stdout, Clock::time_point now = Clock::now());

  /// Collective. Whether it is time to show the state again; the same on all ranks, by rank 0's clock.
  [[nodiscard]] bool due(Clock::time_point now = Clock::now()) const;
  /// Not collective.
  void show(const ProgressState& state, Clock::time_point now = Clock::now());
  /// A line of its own. Not collective.
  void note(const std::string& text);
  /// Shows the last state and leaves the line. Not collective.
  void finish(const ProgressState& state, Clock::time_point now = Clock::now());

 private:
  [[nodiscard]] std::string line(const ProgressState& state, Clock::time_point now) const;

  MPI_Comm comm_;
  ProgressStyle style_;
  double end_;
  std::FILE* out_;
  ProgressState begin_;
  ProgressState shown_;
  Clock::time_point began_;
  Clock::time_point shown_at_;
};

/// "3 s", "12 min 5 s", "3 h 20 min", "2 d 4 h".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace evert
