#include "evert/app/run_loop.hpp"

#include "evert/core/log.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>

namespace evert {
namespace {

volatile std::sig_atomic_t signalled = 0;

void note_signal(int /*signal*/) { signalled = 1; }

double next_stop(const Simulation& simulation, double end_time,
                 std::span<const std::unique_ptr<Observer>> observers) {
  double stop =
      std::min(end_time, simulation.next_event() > simulation.time() ? simulation.next_event() : end_time);
  for (const auto& observer : observers) stop = std::min(stop, observer->next_stop(simulation.time()));
  return stop;
}

/// One of equal steps that end exactly at the next stop.
StepReport step_towards(Simulation& simulation, double stop) {
  const double left = stop - simulation.time();
  constexpr double rounding = 1e-9;
  constexpr double most_steps = 1e15;  // more would not end, nor would their times differ
  const double dt = simulation.suggested_time_step();
  if (!(left / dt < most_steps)) simulation.give_up("the state allows no time step that leads anywhere");
  const double steps = std::ceil(left / dt - rounding);
  return steps <= 1 ? simulation.step_to(stop) : simulation.step(left / steps);
}

}  // namespace

void catch_signals() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

RunEnd run_loop(Simulation& simulation, double end_time,
                std::span<const std::unique_ptr<Observer>> observers) {
  const StageScope stage(Stage::time_steps);
  for (const auto& observer : observers) observer->observe(simulation, {});
  auto end = RunEnd::reached_end_time;
  while (simulation.time() < end_time) {
    // Ranks get a signal at different times: all stop after the same step.
    if (signalled != 0) simulation.request_stop();
    const auto report = step_towards(simulation, next_stop(simulation, end_time, observers));
    for (const auto& observer : observers) observer->observe(simulation, report);
    if (report.stop_requested) {
      end = RunEnd::interrupted;
      break;
    }
  }
  for (const auto& observer : observers) observer->finish(simulation);
  return end;
}

}  // namespace evert
