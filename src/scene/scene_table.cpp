#include "evert/scene/petsc_options.hpp"

#include "tables.hpp"
#include <algorithm>

/// The keys at the top of a scene, and those of the run.
namespace evert {

using namespace schema;

namespace {

const Table<OutputConfig>& output_table() {
  static const auto table =
      Table<OutputConfig>("What is written, and how often.")
          .optional("directory", &OutputConfig::directory, text("path"), "runs/torus",
                    "Made when it does not exist; runs/NAME unless given. Relative to the working directory.")
          .optional("frames_per_second", &OutputConfig::frames_per_second, number("1/s", above(0)), "30",
                    "Frames per simulated second; without it no frames are written.")
          .optional("fields", &OutputConfig::fields,
                    sequence_of(one_of<OutputField>(
                        {{"velocity", OutputField::velocity, "per node [m/s]"},
                         {"min_stretch", OutputField::min_stretch,
                          "per cell, smallest signed principal stretch [-]"},
                         {"inversion", OutputField::inversion, "per cell, 1 where inverted"},
                         {"rank", OutputField::rank, "per cell, the MPI rank that computes it"},
                         {"plastic_strain", OutputField::plastic_strain,
                          "per cell, plastic strain as in tension [-]"},
                         {"plastic_volume", OutputField::plastic_volume,
                          "per cell, volume that plastic flow has left of one [-]"}})),
                    "[velocity, inversion]", "Written besides the positions.")
          .optional("energy_log", &OutputConfig::energy_log, number("s", at_least(0)), "0.01",
                    "Simulated time between rows of energies and momenta in a CSV file, 0 for every step; "
                    "without it, no file.");
  return table;
}

const Table<IntegratorConfig>& integrator_table() {
  static const auto table =
      Table<IntegratorConfig>("How time advances.")
          .optional(
              "method", &IntegratorConfig::method,
              one_of<IntegrationMethod>({{"newmark", IntegrationMethod::newmark,
                                          "elastic forces explicit, damping implicit, second order"},
                                         {"verlet", IntegrationMethod::verlet,
                                          "elastic forces and damping explicit (leapfrog), second order"},
                                         {"symplectic_euler", IntegrationMethod::symplectic_euler,
                                          "both explicit, forces first, first order"},
                                         {"explicit_euler", IntegrationMethod::explicit_euler,
                                          "both explicit, positions first, first order; unstable without "
                                          "damping, and there to show it"},
                                         {"quasistatic", IntegrationMethod::quasistatic,
                                          "states of rest, without inertia, damping and obstacles"}}),
              "newmark", "Time stepping.")
          .optional("mass", &IntegratorConfig::mass,
                    one_of<MassForm>({{"lumped", MassForm::lumped,
                                       "a mass at each node: cheapest, and the only one with obstacles"},
                                      {"consistent", MassForm::consistent,
                                       "the integral of density times two shape functions: accelerations of "
                                       "the order of the element, for smaller steps and a solve in each "
                                       "half of a step"}}),
                    "consistent", "Of newmark: how the mass of a cell acts on its nodes.")
          .optional("time_step", &IntegratorConfig::time_step, word_or_number("auto", "s", above(0)), "1e-4",
                    "auto: the largest stable and accurate step, found anew as the state changes; with "
                    "quasistatic, one step from each frame, event or other time that is hit to the next.")
          .optional("safety", &IntegratorConfig::safety, number("-", above_up_to(0, 1)), "0.5",
                    "With auto: fraction of the stable step.")
          .optional("max_strain_increment", &IntegratorConfig::max_strain_increment, number("-", above(0)),
                    "0.05",
                    "With auto: largest change of strain of an element in one step, relative to its stretch "
                    "above 1.")
          .optional(
              "load_steps", [](auto& config) -> auto& { return config.quasistatic.load_steps; },
              integer(1, 1'000'000), "10",
              "Of quasistatic: parts that a change of loads, materials or prescribed positions is applied "
              "in; "
              "one that does not converge is halved.")
          .optional(
              "tangent", [](auto& config) -> auto& { return config.quasistatic.tangent; },
              one_of<TangentChoice>(
                  {{"adaptive", TangentChoice::adaptive,
                    "projected until Newton's steps halve the residual, full from there on"},
                   {"projected", TangentChoice::projected,
                    "the nearest positive semidefinite tangent of every point"},
                   {"full", TangentChoice::full, "the derivative of the stress as it is"}}),
              "projected", "Of quasistatic: what the Newton steps are made with.")
          .optional(
              "untangle", [](auto& config) -> auto& { return config.quasistatic.untangle; },
              integer(0, 1'000'000), "100",
              "Of quasistatic: where elements are inverted at rest, how many searches in a row around them "
              "may find no state of less energy before that is taken for an answer; 0: none.")
          .then([](IntegratorConfig& config, const Value& map, const std::string& path) {
            const bool statics = config.method == IntegrationMethod::quasistatic;
            const auto refuse = [&](const char* key, const char* method) {
              if (const auto* value = map.find(key); value != nullptr)
                fail(*value, join(path, key),
                     std::string("has no effect: it goes with 'method: ") + method + "'");
            };
            for (const char* key : {"mass", "safety", "max_strain_increment"})
              if (statics) refuse(key, "newmark");
            for (const char* key : {"load_steps", "tangent", "untangle"})
              if (!statics) refuse(key, "quasistatic");
            if (config.mass == MassForm::consistent && config.method != IntegrationMethod::newmark)
              fail(*map.find("mass"), join(path, "mass"),
                   "'consistent' goes with 'method: newmark' only: a scheme without solves needs masses of "
                   "nodes, 'lumped'");
            if (config.method == IntegrationMethod::explicit_euler && !config.time_step) {
              const auto* value = map.find("time_step");
              fail(value != nullptr ? *value : map, join(path, "time_step"),
                   "must be a number of seconds with 'method: explicit_euler': without damping no step is "
                   "stable, and auto has none to choose");
            }
          });
  return table;
}

const Table<FilterConfig>& filter_table() {
  static const auto table =
      Table<FilterConfig>(
          "Slows down what vibrates too fast for the step in bad tetrahedra, and nothing else.")
          .required(
              "time_step", &FilterConfig::time_step, word_or_number("auto", "s", above(0)), "1e-3",
              "The step to be possible; integrator.time_step is at most as large. auto: integrator.time_step "
              "where that is a number, else the one of 1.5 to 10 times the body's own that saves most "
              "time; where none does, nothing is filtered.")
          .optional("selection", &FilterConfig::selection,
                    one_of<FilterSelection>(
                        {{"paper", FilterSelection::paper, "elements too fast for their own mass"},
                         {"spare_mass", FilterSelection::spare_mass,
                          "those too fast for what their neighbours leave them of the mass; never more"},
                         {"adaptive", FilterSelection::adaptive,
                          "the fewest, found from the vibrations of the whole body before the run"}}),
                    "adaptive", "Which elements are filtered. All keep the whole body below the limit.")
          .optional("safety", &FilterConfig::safety, number("-", at_least(1)), "1.5",
                    "How much larger a step the filtered body takes at rest: strain makes it stiffer. Below "
                    "1.25 it "
                    "may blow up.")
          .optional("most_softened", &FilterConfig::most_softened, number("-", above_up_to(0, 1)), "0.01",
                    "With 'time_step: auto': of the mass of any material, the share that may be in softened "
                    "elements.")
          .optional(
              "constraints", &FilterConfig::constraints,
              one_of<FilterConstraints>(
                  {{"none", FilterConstraints::none, "filtered elements are softer than their material"},
                   {"paper", FilterConstraints::paper,
                    "softer, but short edges and heights keep their lengths; connected regions lock"},
                   {"compliant", FilterConstraints::compliant,
                    "they keep all of their forces; what the filter would take off is taken implicitly"}}),
              "none", "What is done about the softness of filtered elements.")
          .optional("projection", &FilterConfig::projection,
                    one_of<FilterProjection>(
                        {{"shake", FilterProjection::shake,
                          "along the gradients at the beginning of the step: angular momentum is kept"},
                         {"goldenthal", FilterProjection::goldenthal, "along those of every iterate"}}),
                    "goldenthal", "How 'constraints: paper' keeps its lengths.")
          .optional("projection_sweeps", &FilterConfig::projection_sweeps, integer(0, 30), "1",
                    "With 'constraints: paper': so many iterations a step, however far lengths are off after "
                    "them; 0: until all are kept to 1e-6 of themselves.")
          .then([](FilterConfig& config, const Value& map, const std::string& path) {
            for (const char* key : {"projection", "projection_sweeps"}) {
              const auto* value = map.find(key);
              if (value != nullptr && config.constraints != FilterConstraints::paper)
                fail(*value, join(path, key), "goes with 'constraints: paper' only");
            }
          });
  return table;
}

const Table<CheckpointConfig>& checkpoint_table() {
  static const auto table =
      Table<CheckpointConfig>("When the state is saved to restart from.")
          .optional("every_simulated", &CheckpointConfig::every_simulated, number("s", above(0)), "0.5",
                    "Simulated time between checkpoints.")
          .optional("every_wall", &CheckpointConfig::every_wall, number("s", above(0)), "600",
                    "Wall time between checkpoints.")
          .then([](CheckpointConfig& checkpoint, const Value& map, const std::string& path) {
            if (!checkpoint.every_simulated && !checkpoint.every_wall)
              fail(map, path, "needs 'every_simulated' [s], 'every_wall' [s] or both");
          });
  return table;
}

/// runs/<name>, with whatever would be awkward in a path replaced.
std::string default_directory(std::string name) {
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (!plain) c = '_';
  }
  return "runs/" + name;
}

/// Throws when an interval [s] fits into the duration so often that time would stand still.
void expect_countable(double interval, double end_time, const Value& map, const char* table,
                      const char* key) {
  constexpr double most = 1e9;
  if (end_time / interval <= most) return;
  const auto& value = *map.find(table)->find(key);
  fail(value, join(table, key),
       shown(value) + " is not allowed: it makes more than 1e9 of them until end_time");
}

/// How hard a body is hit that gives way, only a solve tells.
void expect_no_rigid_bodies_without_solve(const SceneConfig& scene, const Value& map) {
  const auto method = scene.integrator.method;
  if (method != IntegrationMethod::symplectic_euler && method != IntegrationMethod::explicit_euler) return;
  for (const auto& obstacle : scene.obstacles) {
    if (!obstacle.mass && !obstacle.density) continue;
    const auto path = join("obstacles", obstacle.name);
    const char* key = obstacle.mass ? "mass" : "density";
    fail(*map.find("obstacles")->find(obstacle.name)->find(key), join(path, key),
         "a rigid body with a mass goes with 'integrator.method: newmark' or 'verlet' only");
  }
}

/// Throws for a filter that the steps make nothing of.
void check_filter(const SceneConfig& scene, const Value& map) {
  if (!scene.filter) return;
  const auto refuse = [&](const std::string& why) { fail(*map.find("filter"), "filter", why); };
  if (scene.integrator.method == IntegrationMethod::quasistatic)
    refuse(
        "has no effect with 'integrator.method: quasistatic', which has no stable step: it goes with "
        "'newmark'");
  if (scene.integrator.method == IntegrationMethod::explicit_euler)
    refuse(
        "is not possible with 'integrator.method: explicit_euler', which no filter makes stable: it goes "
        "with 'newmark'");
  if (scene.integrator.mass == MassForm::consistent)
    refuse(
        "is not possible with 'integrator.mass: consistent': elements are filtered against masses of "
        "nodes, 'lumped'");
  if (scene.filter->time_step && scene.integrator.time_step.value_or(0) > *scene.filter->time_step) {
    const auto& value = *map.find("integrator")->find("time_step");
    fail(value, "integrator.time_step",
         shown(value) +
             " is not allowed: must be at most filter.time_step, for which the elements are filtered");
  }
}

void finish_scene(SceneConfig& scene, const Value& map, const std::string& /*path*/) {
  if (scene.output.directory.empty()) scene.output.directory = default_directory(scene.name);
  if (scene.integrator.time_step)
    expect_countable(*scene.integrator.time_step, scene.end_time, map, "integrator", "time_step");
  if (scene.output.frames_per_second)
    expect_countable(1 / *scene.output.frames_per_second, scene.end_time, map, "output", "frames_per_second");
  if (scene.output.energy_log.value_or(0) > 0)
    expect_countable(*scene.output.energy_log, scene.end_time, map, "output", "energy_log");
  if (scene.checkpoint && scene.checkpoint->every_simulated)
    expect_countable(*scene.checkpoint->every_simulated, scene.end_time, map, "checkpoint",
                     "every_simulated");
  if (scene.integrator.mass == MassForm::consistent && !scene.obstacles.empty())
    fail(*map.find("obstacles"), "obstacles",
         "is not possible with 'integrator.mass: consistent': impacts and friction need masses of nodes, "
         "'lumped'");
  expect_no_rigid_bodies_without_solve(scene, map);
  check_filter(scene, map);
  if (scene.bodies.empty()) fail(*map.find("bodies"), "bodies", "must name at least one body");
  for (const auto& [name, value] : scene.petsc) {
    const auto& entry = *map.find("petsc")->find(name);
    if (name.starts_with('-')) fail(entry, "petsc." + name, "is written without its dash: " + name.substr(1));
    const auto& process = process_options();
    if (std::find(process.begin(), process.end(), name) != process.end())
      fail(entry, "petsc." + name,
           "must be given on the command line: PETSc reads it when there is no scene yet, or no more");
  }
}

}  // namespace

const Table<SceneConfig>& scene_table() {
  static const auto table =
      Table<SceneConfig>(
          "A scene. SI units everywhere; a feature that is not named is not there and costs nothing.")
          .optional("schema_version", &SceneConfig::schema_version, integer(1, 1), "1",
                    "Version of this format, for scenes that must say it.")
          .required("name", &SceneConfig::name, text("name"), "torus puddle", "Name of the scene.")
          .required("end_time", &SceneConfig::end_time, number("s", above(0)), "2", "Simulated time.")
          .optional("output", &SceneConfig::output, table_of(output_table()), "{frames_per_second: 30}",
                    "What is written.")
          .optional("gravity", &SceneConfig::gravity, gravity_type(), "[0, -9.81, 0]",
                    "Acceleration of all bodies.")
          .required("bodies", &SceneConfig::bodies, named(body_table()),
                    "{ball: {mesh: ..., density: 1000, material: ...}}", "The deformable bodies, by name.")
          .optional("obstacles", &SceneConfig::obstacles, named(obstacle_table()),
                    "{ground: {shape: half_space, friction: 0.4}}", "The rigid obstacles, by name.")
          .optional("constraints", &SceneConfig::constraints, sequence_of(table_of(constraint_table())),
                    "[{body: beam, node_set: x_min, fixed: true}]", "Nodes that are held or moved.")
          .optional("events", &SceneConfig::events, sequence_of(table_of(event_table())),
                    "[{at: 0.5, set: gravity, to: [0, 0, 0]}]", "Values that change at a time.")
          .optional("integrator", &SceneConfig::integrator, table_of(integrator_table()), "{time_step: auto}",
                    "How time advances.")
          .optional("filter", &SceneConfig::filter, table_of(filter_table()), "{time_step: 1e-3}",
                    "Without it, every element is as stiff as it is.")
          .optional("checkpoint", &SceneConfig::checkpoint, table_of(checkpoint_table()), "{every_wall: 600}",
                    "Without it, no checkpoints.")
          .optional("petsc", &SceneConfig::petsc, scalars_by_name("option: value"),
                    "{damping_ksp_rtol: 1e-6}",
                    "PETSc options, without their dash; the command line overrides them.")
          .then(finish_scene);
  return table;
}

}  // namespace evert
