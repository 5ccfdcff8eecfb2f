#pragma once
#include "evert/sim/simulation.hpp"

#include <limits>

namespace evert {

/// Looks at a running simulation between steps: frames, logs, checkpoints, progress.
class Observer {
 public:
  virtual ~Observer() = default;

  /// The next time after `time` that the run must hit exactly [s].
  [[nodiscard]] virtual double next_stop(double /*time*/) const {
    return std::numeric_limits<double>::infinity();
  }
  /// Collective. Called once before the first step and after every step.
  virtual void observe(Simulation& simulation, const StepReport& report) = 0;
  /// Collective. Called once after the last step, also when the run was interrupted.
  virtual void finish(Simulation& /*simulation*/) {}
};

/// Times k/rate for whole k, hit exactly whatever the steps are; knows no history, so that a restart goes on
/// with it.
class Schedule {
 public:
  explicit Schedule(double interval) : interval_(interval) {}
  [[nodiscard]] double next_after(double time) const;
  /// True when `time` is one of the times.
  [[nodiscard]] bool due(double time) const;

 private:
  double interval_;  // [s]
};

}  // namespace evert
