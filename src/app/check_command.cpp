#include "evert/app/check_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/app/observer.hpp"
#include "evert/core/formatted.hpp"
#include "evert/core/petsc.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/material.hpp"
#include "evert/scene/petsc_options.hpp"

#include <petscsys.h>

#include "filter_report.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numeric>

namespace evert {
namespace {

std::string vector_text(const Vec3d& v) { return formatted("(%g, %g, %g)", v[0], v[1], v[2]); }

std::string duration_text(double seconds) {
  if (seconds < 120) return formatted("%.2g s", seconds);
  if (seconds < 7200) return formatted("%.0f min", seconds / 60);
  return formatted("%.3g h", seconds / 3600);
}

std::string material_text(const MaterialConfig& material) {
  auto model = name_of(material.model);
  if (material.peak_stress) model += formatted(", peak stress %g Pa", *material.peak_stress);
  if (material.youngs_modulus)
    return model + formatted(", E %g Pa, nu %g", *material.youngs_modulus, *material.poissons_ratio);
  const Lame lame = lame_of(material);
  return model + formatted(", lambda %g Pa, mu %g Pa", lame.lambda, lame.mu);
}

std::string plasticity_text(const PlasticityConfig& plasticity) {
  auto text = plasticity.yield_stress ? formatted("yields at %g Pa", *plasticity.yield_stress)
                                      : formatted("yields at a log strain of %g", *plasticity.yield_strain);
  if (!plasticity.isochoric) text += ", volume and all";
  if (plasticity.goal) text += ", led to a goal";
  return text;
}

std::string fibre_text(const FibreConfig& fibres) {
  if (const auto* constant = std::get_if<ConstantFibres>(&fibres))
    return "fibres along " + vector_text(constant->direction);
  if (const auto* field = std::get_if<FieldFibres>(&fibres))
    return "fibres by the field '" + field->field + "' of the mesh file";
  return formatted("fibres along a curve of %zu points", std::get<CurveFibres>(fibres).curve.size());
}

std::string activation_text(const ActivationConfig& keys) {
  if (keys.size() == 1) return formatted("activation %g", keys.front().value);
  return formatted("activation from %g at %g s to %g at %g s, %zu times in all", keys.front().value,
                   keys.front().time, keys.back().value, keys.back().time, keys.size());
}

/// Of the rate of strain.
std::string strain_damping_text(const DampingConfig& damping) {
  const std::string model = damping.model == DampingModel::rotated     ? "rotated"
                            : damping.model == DampingModel::objective ? "objective"
                                                                       : "blended";
  if (damping.stiffness_proportional)
    return model + formatted(" damping, stiffness-proportional %g s", *damping.stiffness_proportional);
  if (damping.stiffness_ratio)
    return model +
           formatted(" damping, stiffness ratio %g at %g Hz", *damping.stiffness_ratio, damping.frequency);
  return model + formatted(" damping, alpha %g, beta %g Pa s", damping.alpha, damping.beta);
}

std::string damping_text(const std::optional<DampingConfig>& damping) {
  std::vector<std::string> parts;
  if (damping && damping->model != DampingModel::none) parts.push_back(strain_damping_text(*damping));
  if (damping && damping->mass_proportional)
    parts.push_back(formatted("mass-proportional damping %g /s", *damping->mass_proportional));
  if (damping && damping->mass_ratio)
    parts.push_back(
        formatted("mass-proportional damping, ratio %g at %g Hz", *damping->mass_ratio, damping->frequency));
  if (parts.empty()) return "undamped";
  return parts.size() == 1 ? parts[0] : parts[0] + ", " + parts[1];
}

/// Writes "title   text", the title only when it differs from the line before.
class Report {
 public:
  explicit Report(std::ostream& out) : out_(out) {}

  void line(const std::string& title, const std::string& text) {
    out_ << formatted("%-13s", title == last_ ? "" : title.c_str()) << text << '\n';
    last_ = title;
  }

 private:
  std::ostream& out_;
  std::string last_;
};

void report_bodies(Report& report, const SceneConfig& scene, const BuiltScene& built) {
  const auto& mesh = built.simulation->mesh();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    const auto& range = built.bodies[b];
    report.line("bodies",
                body.name + ": " +
                    formatted("%lld nodes, box ", static_cast<long long>(range.end_node - range.first_node)) +
                    vector_text(range.lower) + " to " + vector_text(range.upper) + " m");
    report.line("bodies", formatted("  density %g kg/m^3, ", body.density) + material_text(body.material) +
                              ", " + damping_text(body.damping) +
                              (body.precision == Precision::mixed ? ", mixed precision" : ""));
    if (body.fibres) report.line("bodies", "  " + fibre_text(*body.fibres));
    if (body.activation) report.line("bodies", "  " + activation_text(*body.activation));
    if (body.plasticity) report.line("bodies", "  " + plasticity_text(*body.plasticity));
    for (const auto& group : body.groups)
      report.line("bodies", "  " + group.name + ": " +
                                formatted("density %g kg/m^3, ", group.density.value_or(body.density)) +
                                material_text(group.material.value_or(body.material)) + ", " +
                                damping_text(group.damping ? group.damping : body.damping) +
                                (group.activation ? ", " + activation_text(*group.activation) : "") +
                                (group.plasticity ? ", " + plasticity_text(*group.plasticity) : ""));
  }
  for (const auto& cells : mesh.cells)
    if (cells.size() > 0)
      report.line("cells", formatted("%d %s in ", cells.size(), std::string(name_of(cells.type)).c_str()) +
                               mesh.regions[static_cast<std::size_t>(cells.region)]);
  const auto masses = built.simulation->elastic().masses();
  report.line("mass", formatted("%.6g kg in all", std::accumulate(masses.begin(), masses.end(), 0.0)) +
                          (scene.integrator.mass == MassForm::consistent ? ", consistent" : ""));
}

std::string motion_text(const ObstacleConfig& obstacle, const Simulation& simulation) {
  for (const auto& built : simulation.obstacles())
    if (built->name() == obstacle.name && built->body() != nullptr)
      return formatted(", a rigid body of %.6g kg", built->body()->mass().mass);
  if (!obstacle.motion) return norm(obstacle.velocity) > 0 ? ", moving steadily" : "";
  if (!obstacle.motion->file.empty()) return ", moving as " + obstacle.motion->file + " says";
  if (!obstacle.motion->keyframes.empty()) return ", moving by keyframes";
  return obstacle.motion->frequency > 0
             ? formatted(", moving to and fro at %g Hz", obstacle.motion->frequency)
             : ", moving steadily";
}

void report_surroundings(Report& report, const SceneConfig& scene, const Simulation& simulation) {
  const auto& mesh = simulation.mesh();
  for (const auto& obstacle : scene.obstacles) {
    report.line("obstacles", obstacle.name + ": " + name_of(obstacle.shape.solid) +
                                 formatted(", friction %g", obstacle.friction) +
                                 motion_text(obstacle, simulation));
  }
  for (std::size_t c = 0; c < scene.constraints.size(); ++c) {
    const auto& constraint = scene.constraints[c];
    report.line("constraints", formatted("%zu nodes of ", mesh.node_sets[c].owned.size()) +
                                   constraint.body_name +
                                   (constraint.fixed ? " are fixed" : " have a prescribed velocity"));
  }
  for (const auto& event : scene.events)
    report.line("events", formatted("at %g s ", event.at) + event.set + " becomes " +
                              (event.target == EventTarget::gravity ? vector_text(event.vector)
                                                                    : formatted("%g", event.value)));
}

/// Processor seconds of one step (wall time would measure what else the machine does). The first step of a
/// motion also sets the solvers up; of states of rest it is the one with the most to do.
double seconds_a_step(Simulation& simulation, double dt) {
  if (!simulation.quasistatic()) simulation.step(dt);
  const auto begin = std::clock();
  simulation.step(dt);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
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

void report_cost(Report& report, const SceneConfig& scene, Simulation& simulation) {
  const auto stretches = time_steps(simulation, scene);
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
  const double step_seconds = seconds_a_step(simulation, stretches.back().dt);
  PetscLogDouble resident = 0;
  check(PetscMemoryGetCurrentUsage(&resident));
  constexpr double mega = 1e6;
  const auto elements = static_cast<double>(simulation.elastic().memory());
  double cells = 0;
  for (const auto& of_region : simulation.mesh().cells) cells += static_cast<double>(of_region.size());
  report.line("memory", formatted("%.1f MB, of which element data %.1f MB, %.0f bytes a cell",
                                  resident / mega, elements / mega, elements / cells));
  report.line("cost", formatted("%.2g s a step at the start, on one rank: ", step_seconds) +
                          duration_text(steps * step_seconds) +
                          " for these steps; output and harder damping solves come on top");
}

}  // namespace

int check_command(std::span<const std::string> arguments, std::ostream& out) {
  if (asks_for_help(arguments)) {
    out << check_usage();
    return 0;
  }
  const auto run = parse_run_arguments(arguments, "check");
  const auto scene = load_scene(PETSC_COMM_SELF, run.scene, run.overrides);
  apply_petsc_block(scene);
  require_option_values(scene, run.petsc);
  const auto built = build_scene(PETSC_COMM_SELF, scene);

  Report report(out);
  report.line("scene", scene.name + " (" + scene.file + ")");
  report_bodies(report, scene, built);
  if (const auto* filter = built.simulation->filter())
    for (const auto& line : filter_lines(PETSC_COMM_SELF, *filter)) report.line("filter", line);
  report_surroundings(report, scene, *built.simulation);
  report_cost(report, scene, *built.simulation);
  reject_unused_options(PETSC_COMM_SELF, run.allow_unknown_options, solvers_of(*built.simulation));
  report.line("valid", "nothing wrong was found");
  return 0;
}

}  // namespace evert
