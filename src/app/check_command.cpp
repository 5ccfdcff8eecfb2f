#include "evert/app/check_command.hpp"

#include "evert/app/command_line.hpp"
#include "evert/core/formatted.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/material.hpp"
#include "evert/scene/petsc_options.hpp"

#include "cost_report.hpp"
#include "filter_report.hpp"
#include "report.hpp"
#include <numeric>

namespace evert {
namespace {

std::string vector_text(const Vec3d& v) { return formatted("(%g, %g, %g)", v[0], v[1], v[2]); }

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
  if (!plasticity.isochoric) text += ", of the volume too";
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
  report_features(report, scene, run.scene, run.overrides);
  reject_unused_options(PETSC_COMM_SELF, run.allow_unknown_options, solvers_of(*built.simulation));
  report.line("valid", "nothing wrong was found");
  return 0;
}

}  // namespace evert
