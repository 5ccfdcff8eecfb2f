#pragma once
#include "evert/app/observer.hpp"
#include "evert/io/checkpoint.hpp"
#include "evert/io/csv_log.hpp"
#include "evert/io/frame_writer.hpp"
#include "evert/io/progress.hpp"
#include "evert/scene/config.hpp"

#include <memory>
#include <string>
#include <vector>

/// What looks at a run: one small class each, made only where the scene asks for it.
namespace evert {

/// Counts what the summary reports. The inverted points are looked at whenever a frame or a row of the log is
/// due.
class RunStatistics final : public Observer {
 public:
  explicit RunStatistics(double interval) : schedule_(interval) {}
  void observe(Simulation& simulation, const StepReport& report) override;
  void finish(Simulation& simulation) override { look(simulation); }

  std::int64_t cg_iterations = 0;
  std::int64_t newton_iterations = 0;
  std::int64_t linear_iterations = 0;
  GlobalIndex inverted = 0;  ///< at the last look
  GlobalIndex max_inverted = 0;
  double max_inverted_time = 0;  ///< [s]

 private:
  void look(const Simulation& simulation);
  Schedule schedule_;
};

/// Frames at k / frames_per_second.
class FrameObserver final : public Observer {
 public:
  FrameObserver(FrameWriter writer, double interval) : writer_(std::move(writer)), schedule_(interval) {}
  [[nodiscard]] double next_stop(double time) const override { return schedule_.next_after(time); }
  void observe(Simulation& simulation, const StepReport& report) override;
  void finish(Simulation& simulation) override;
  [[nodiscard]] std::int64_t frames() const { return static_cast<std::int64_t>(writer_.frames().size()); }

 private:
  void write(const Simulation& simulation);
  FrameWriter writer_;
  Schedule schedule_;
};

/// Rows of energies and momenta, every `interval` [s]; 0: after every step.
class EnergyObserver final : public Observer {
 public:
  EnergyObserver(EnergyLog log, double interval) : log_(std::move(log)), interval_(interval) {}
  [[nodiscard]] double next_stop(double time) const override;
  void observe(Simulation& simulation, const StepReport& report) override;

 private:
  EnergyLog log_;
  double interval_;
};

/// Rows of what obstacles do, at the times of the energy log.
class ObstacleObserver final : public Observer {
 public:
  ObstacleObserver(ObstacleLog log, double interval) : log_(std::move(log)), interval_(interval) {}
  [[nodiscard]] double next_stop(double time) const override;
  void observe(Simulation& simulation, const StepReport& report) override;

 private:
  ObstacleLog log_;
  double interval_;
};

/// Checkpoints by simulated and by wall time, and one when the run ends early. None of a motion that begins
/// to explode: the last good one stays.
class CheckpointObserver final : public Observer {
 public:
  CheckpointObserver(CheckpointWriter writer, const CheckpointConfig& config);
  [[nodiscard]] double next_stop(double time) const override;
  void observe(Simulation& simulation, const StepReport& report) override;
  void write(const Simulation& simulation);
  /// The simulated time of the last one [s]; negative: none was written.
  [[nodiscard]] double written_at() const { return written_at_; }

 private:
  [[nodiscard]] bool due(const Simulation& simulation) const;
  CheckpointWriter writer_;
  CheckpointConfig config_;
  double written_at_wall_;  // [s]
  double written_at_ = -1;  // [s] simulated
  bool held_back_ = false;  // one is due
};

/// The progress line.
class ProgressObserver final : public Observer {
 public:
  ProgressObserver(const Simulation& simulation, double end_time, bool quiet,
                   const RunStatistics& statistics);
  void observe(Simulation& simulation, const StepReport& report) override;
  void finish(Simulation& simulation) override;

 private:
  [[nodiscard]] ProgressState state(const Simulation& simulation) const;
  const RunStatistics& statistics_;
  Progress progress_;
};

}  // namespace evert
