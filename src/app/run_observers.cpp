#include "evert/app/run_observers.hpp"

#include "evert/core/log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evert {

void RunStatistics::observe(Simulation& simulation, const StepReport& report) {
  cg_iterations += report.cg_iterations;
  newton_iterations += report.newton_iterations;
  linear_iterations += report.linear_iterations;
  if (schedule_.due(simulation.time())) look(simulation);
}

void RunStatistics::look(const Simulation& simulation) {
  inverted = simulation.inverted_points();
  if (inverted <= max_inverted) return;
  max_inverted = inverted;
  max_inverted_time = simulation.time();
}

void FrameObserver::observe(Simulation& simulation, const StepReport& /*report*/) {
  if (schedule_.due(simulation.time())) write(simulation);
}

void FrameObserver::finish(Simulation& simulation) {
  if (!schedule_.due(simulation.time())) write(simulation);  // the last state is worth seeing, whenever it is
}

void FrameObserver::write(const Simulation& simulation) {
  // A restart begins at a frame that is there already.
  const auto frames = writer_.frames();
  if (!frames.empty() && frames.back().time >= simulation.time()) return;
  writer_.write(frame_source(simulation));
}

namespace {

double next_row(double interval, double time) {
  return interval > 0 ? Schedule(interval).next_after(time) : std::numeric_limits<double>::infinity();
}

/// The state that a restart begins with: the run before has written its row.
bool is_first_of_restart(const Simulation& simulation, const StepReport& report) {
  return report.dt == 0 && simulation.steps() > 0;
}

bool row_due(double interval, const Simulation& simulation) {
  return !(interval > 0) || Schedule(interval).due(simulation.time());
}

}  // namespace

double EnergyObserver::next_stop(double time) const { return next_row(interval_, time); }

void EnergyObserver::observe(Simulation& simulation, const StepReport& report) {
  if (is_first_of_restart(simulation, report) || !row_due(interval_, simulation)) return;
  const PhaseScope scope(Phase::io);
  log_.write(simulation.steps(), simulation.time(), simulation.measure());
}

double ObstacleObserver::next_stop(double time) const { return next_row(interval_, time); }

void ObstacleObserver::observe(Simulation& simulation, const StepReport& report) {
  const bool begins = is_first_of_restart(simulation, report);
  if (!begins && !row_due(interval_, simulation)) return;
  const PhaseScope scope(Phase::io);
  const auto impulses = simulation.obstacle_impulses();
  if (begins)
    log_.begin_at(simulation.time(), impulses);
  else
    log_.write(simulation.steps(), simulation.time(), simulation.obstacles(), impulses);
}

CheckpointObserver::CheckpointObserver(CheckpointWriter writer, const CheckpointConfig& config)
    : writer_(std::move(writer)), config_(config), written_at_wall_(MPI_Wtime()) {}

double CheckpointObserver::next_stop(double time) const {
  return config_.every_simulated ? Schedule(*config_.every_simulated).next_after(time)
                                 : Observer::next_stop(time);
}

bool CheckpointObserver::due(const Simulation& simulation) const {
  if (config_.every_simulated && Schedule(*config_.every_simulated).due(simulation.time())) return true;
  if (!config_.every_wall) return false;
  // The clock of rank 0 decides for all.
  int late = MPI_Wtime() - written_at_wall_ >= *config_.every_wall ? 1 : 0;
  MPI_Bcast(&late, 1, MPI_INT, 0, simulation.mesh().comm);
  return late != 0;
}

void CheckpointObserver::observe(Simulation& simulation, const StepReport& report) {
  if (report.dt == 0 || !(due(simulation) || held_back_)) return;
  held_back_ = simulation.suspicious();
  if (!held_back_) write(simulation);
}

void CheckpointObserver::write(const Simulation& simulation) {
  if (written_at_ == simulation.time()) return;
  writer_.write(simulation.node_state(), simulation.state_scalars(), simulation.flow_state());
  written_at_ = simulation.time();
  written_at_wall_ = MPI_Wtime();
}

ProgressObserver::ProgressObserver(const Simulation& simulation, double end_time, bool quiet,
                                   const RunStatistics& statistics)
    : statistics_(statistics),
      progress_(simulation.mesh().comm, progress_style(quiet), state(simulation), end_time) {}

ProgressState ProgressObserver::state(const Simulation& simulation) const {
  return {simulation.time(), simulation.steps(), statistics_.inverted, statistics_.cg_iterations};
}

void ProgressObserver::observe(Simulation& simulation, const StepReport& report) {
  for (const auto& note : report.notes) progress_.note(note);
  if (progress_.due()) progress_.show(state(simulation));
}

void ProgressObserver::finish(Simulation& simulation) { progress_.finish(state(simulation)); }

}  // namespace evert
