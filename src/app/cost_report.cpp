#include "cost_report.hpp"

#include "evert/app/observer.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/log.hpp"
#include "evert/core/memory_in_use.hpp"
#include "evert/core/petsc.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/material.hpp"

#include <petscsys.h>

#include "feature_costs.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

namespace evert {
namespace {

std::string duration_text(double seconds) {
  if (seconds < 120) return formatted("%.2g s", seconds);
  if (seconds < 7200) return formatted("%.0f min", seconds / 60);
  return formatted("%.3g h", seconds / 3600);
}

/// What some steps took.
struct Measured {
  double processor = 0;  ///< [s] a step: wall time would measure what else the machine does
  std::array<double, phase_count> shares{};  ///< of the time of all phases
};

/// The first step of a motion also sets the solvers up; of states of rest it is the one with the most to do.
Measured measure_steps(Simulation& simulation, double dt) {
  constexpr double long_enough = 0.02;  // [s]
  constexpr int most = 50;              // so that the start is what is measured
  if (!simulation.quasistatic()) simulation.step(dt);
  const auto before = phase_seconds();
  const auto begin = std::clock();
  Measured steps;
  int count = 0;
  do {
    simulation.step(std::min(dt, simulation.suggested_time_step()));
    ++count;
    steps.processor = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  } while (steps.processor < long_enough && count < most);
  steps.processor /= count;
  double sum = 0;
  for (std::size_t p = 0; p < phase_count; ++p) sum += steps.shares[p] = phase_seconds()[p] - before[p];
  for (double& share : steps.shares) share /= sum;
  return steps;
}

std::string shares_text(const std::array<double, phase_count>& shares) {
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < phase_count; ++p)
    if (shares[p] >= 0.005) order.push_back(p);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  std::string text;
  for (const std::size_t p : order)
    text += (text.empty() ? "" : ", ") + std::string(name_of(static_cast<Phase>(p))) +
            formatted(" %.0f %%", 100 * shares[p]);
  return text;
}

/// Gives the regions of an event's body what the scene says now. Regions are called "body" or "body.group".
void set_regions(Simulation& simulation, const BodyConfig& body) {
  const auto& regions = simulation.mesh().regions;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    int group = -1;
    for (std::size_t g = 0; g < body.groups.size(); ++g)
      if (regions[r] == body.name + "." + body.groups[g].name) group = static_cast<int>(g);
    if (group >= 0 || regions[r] == body.name)
      simulation.set_properties(static_cast<std::int32_t>(r), properties_of(body, group));
  }
}

/// The step between two events; an automatic one as the initial state suggests it.
struct Stretch {
  double begin = 0;
  double dt = 0;
};

std::vector<Stretch> time_steps(Simulation& simulation, SceneConfig scene) {
  std::vector<Stretch> out{{0, std::min(simulation.suggested_time_step(), scene.end_time)}};
  for (const auto& event : scene.events) {
    if (event.at >= scene.end_time) continue;
    apply_event(scene, event);
    if (event.target == EventTarget::material || event.target == EventTarget::damping)
      set_regions(simulation, scene.bodies[event.owner]);
    out.push_back({event.at, std::min(simulation.suggested_time_step(), scene.end_time)});
  }
  const auto cut = [&](const std::optional<ActivationConfig>& keys) {
    for (const auto& key : keys.value_or(ActivationConfig{})) {
      if (!(key.time > 0 && key.time < scene.end_time)) continue;
      const auto later = std::ranges::upper_bound(out, key.time, {}, &Stretch::begin);
      out.insert(later, {key.time, (later - 1)->dt});
    }
  };
  for (const auto& body : scene.bodies) {
    cut(body.activation);
    for (const auto& group : body.groups) cut(group.activation);
  }
  return out;
}

/// Times that the run hits exactly, besides those of events.
std::vector<Schedule> stops_of(const SceneConfig& scene) {
  std::vector<Schedule> stops;
  if (const auto rate = scene.output.frames_per_second) stops.emplace_back(1 / *rate);
  if (const auto interval = scene.output.energy_log; interval.value_or(0) > 0) stops.emplace_back(*interval);
  if (scene.checkpoint && scene.checkpoint->every_simulated)
    stops.emplace_back(*scene.checkpoint->every_simulated);
  return stops;
}

/// Steps of at most `dt` from `begin` to `end`, as run_loop makes them: equal ones from stop to stop. Walks
/// over some stops and takes the rest to be like them.
double steps_between(double begin, double end, double dt, std::span<const Schedule> stops) {
  constexpr int most_stops = 100'000;
  double steps = 0;
  double time = begin;
  for (int i = 0; i < most_stops && time < end; ++i) {
    double stop = end;
    for (const auto& schedule : stops) stop = std::min(stop, schedule.next_after(time));
    steps += std::max(1.0, std::ceil((stop - time) / dt - 1e-9));
    time = stop;
  }
  return steps * (end - begin) / (time - begin);
}

void report_memory(Report& report, const Simulation& simulation) {
  PetscLogDouble resident = 0;
  check(PetscMemoryGetCurrentUsage(&resident));
  constexpr double mega = 1e6;
  const auto elements = static_cast<double>(simulation.elastic().memory());
  double cells = 0;
  for (const auto& of_region : simulation.mesh().cells) cells += static_cast<double>(of_region.size());
  report.line("memory", formatted("%.1f MB, of which element data %.1f MB, %.0f bytes a cell",
                                  resident / mega, elements / mega, elements / cells));
  report.line("memory", formatted("plastic state %.1f MB",
                                  static_cast<double>(simulation.elastic().plastic_memory()) / mega));
}

/// What the time step is, from event to event. Returns how many there are about.
double report_steps(Report& report, const SceneConfig& scene, const std::vector<Stretch>& stretches) {
  const auto stops = stops_of(scene);
  const bool fixed = scene.integrator.time_step.has_value();
  double steps = 0;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double end = i + 1 < stretches.size() ? stretches[i + 1].begin : scene.end_time;
    if (end > stretches[i].begin) steps += steps_between(stretches[i].begin, end, stretches[i].dt, stops);
    if (i > 0 && stretches[i].dt == stretches[i - 1].dt) continue;
    report.line("time step", formatted("%.4g s from t = %g s", stretches[i].dt, stretches[i].begin) +
                                 (fixed ? ", fixed"
                                  : scene.integrator.method == IntegrationMethod::quasistatic
                                      ? ", one load step from stop to stop"
                                      : ", automatic, as the initial state suggests"));
  }
  report.line("steps", formatted("%s %.6g to the end time, %g s: these, cut to hit frames, log rows, "
                                 "checkpoints and events exactly",
                                 fixed ? "about" : "at least", steps, scene.end_time));
  if (scene.integrator.method == IntegrationMethod::quasistatic)
    report.line("steps", "each in parts where it does not converge at once (integrator.load_steps)");
  else if (!fixed)
    report.line("steps", "more where elements stiffen or deform quickly (integrator.max_strain_increment)");
  if (const auto rate = scene.output.frames_per_second)
    report.line("frames", formatted("%.0f to ", std::floor(scene.end_time * *rate * (1 + 1e-12)) + 1) +
                              scene.output.directory);
  else
    report.line("frames", "none: output.frames_per_second is not given");
  return steps;
}

/// "costs 1.2 times as much a step, which is 3.1 times as long; 0.2 MB"
std::string feature_text(const StepCost& with, const StepCost& without) {
  constexpr double mega = 1e6;
  const double seconds = with.seconds / without.seconds, length = with.time_step / without.time_step;
  auto text = formatted("a step costs %.2f times what it does without", seconds);
  if (std::abs(length - 1) > 0.01)
    text += formatted(", is %.3g times as long: %.3g times the cost of a second", length, seconds / length);
  return text + formatted("; %+.2f MB",
                          (static_cast<double>(with.memory) - static_cast<double>(without.memory)) / mega);
}

}  // namespace

void report_cost(Report& report, const SceneConfig& scene, Simulation& simulation) {
  const auto stretches = time_steps(simulation, scene);
  const double steps = report_steps(report, scene, stretches);
  const auto step = measure_steps(simulation, stretches.back().dt);
  report_memory(report, simulation);
  report.line("cost", formatted("%.2g s a step at the start, on one rank: ", step.processor) +
                          duration_text(steps * step.processor) +
                          " for these steps; output and harder damping solves come on top");
  report.line("work", shares_text(step.shares) + " of these steps");
}

void report_features(Report& report, const SceneConfig& scene, const std::string& path,
                     std::span<const std::string> overrides) {
  const auto features = features_of(scene);
  if (features.empty()) return report.line("features", "none that could be left out");
  constexpr double most = 2e9;  // [bytes] of all bodies that are compared
  if (static_cast<double>((features.size() + 1) * memory_in_use()) > most)
    return report.line("features",
                       "not measured: with and without each, the scene would not fit into memory");
  const auto costs = scene_costs(path, overrides, features);
  for (const auto& [name, without] : costs.features)
    report.line("features",
                name + ": " + (without ? feature_text(costs.whole, *without) : "cannot be left out here"));
}

}  // namespace evert
