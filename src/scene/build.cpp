#include "evert/scene/build.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/log.hpp"
#include "evert/scene/load.hpp"
#include "evert/scene/material.hpp"

#include "goals.hpp"
#include "obstacles.hpp"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace evert {
namespace {

/// Of the rate of strain. A vibration of frequency f gets the damping ratio π f τ of it.
Damping damping_of(const std::optional<DampingConfig>& config, const MaterialConfig& material) {
  if (!config || config->model == DampingModel::none) return {};
  if (!config->stiffness_proportional && !config->stiffness_ratio)
    return {config->model, config->alpha, config->beta};
  const double time = config->stiffness_ratio
                          ? *config->stiffness_ratio / (std::numbers::pi * config->frequency)
                          : *config->stiffness_proportional;
  const auto lame = lame_of(material);
  return Damping::stiffness_proportional(config->model, time, lame.lambda, lame.mu);
}

/// Of velocity [1/s]. A vibration of frequency f gets the damping ratio a/(4π f) of it.
std::optional<double> mass_damping_of(const std::optional<DampingConfig>& config) {
  if (!config) return {};
  if (config->mass_ratio) return 4 * std::numbers::pi * config->frequency * *config->mass_ratio;
  return config->mass_proportional;
}

std::optional<Plasticity> plasticity_of(const std::optional<PlasticityConfig>& config,
                                        const MaterialConfig& material) {
  if (!config) return {};
  const double mu = lame_of(material).mu;
  const double yield =
      config->yield_strain ? *config->yield_strain : Plasticity::yield_of_stress(*config->yield_stress, mu);
  const double hardening = config->hardening_modulus
                               ? Plasticity::hardening_of_modulus(*config->hardening_modulus, mu)
                               : config->hardening.value_or(0);
  return Plasticity{yield, hardening, config->isochoric, config->relaxation_time, config->limit};
}

PrescribedNodes prescribed_of(const ConstraintConfig& config, const LocalNodeSet& nodes) {
  PrescribedNodes group{nodes.owned, {}, config.axes, config.from, config.until};
  for (const auto& key : config.velocity) group.keyframes.push_back({key.time, key.velocity});
  return group;
}

/// A random point of the body's bounding box that depends on the seed and the node's number only.
Vec3d scrambled(const BodyRange& body, std::uint64_t seed, GlobalIndex node) {
  std::seed_seq mix{seed & 0xffffffffU, seed >> 32U, static_cast<std::uint64_t>(node) & 0xffffffffU,
                    static_cast<std::uint64_t>(node) >> 32U};
  std::mt19937_64 random(mix);
  Vec3d point{};
  for (std::size_t k = 0; k < 3; ++k)
    point[k] = std::uniform_real_distribution<double>(body.lower[k], body.upper[k])(random);
  return point;
}

Vec3d start_target(const StartConfig& start, const BodyRange& body, const Vec3d& rest, GlobalIndex node) {
  const auto center = 0.5 * (body.lower + body.upper);
  const double along = dot(rest - center, start.axis);
  switch (start.kind) {
    case StartKind::scramble:
      return scrambled(body, start.seed, node);
    case StartKind::flatten_plane:
      return rest - along * start.axis;
    case StartKind::flatten_line:
      return center + along * start.axis;
    case StartKind::flatten_point:
      return center;
    case StartKind::inside_out:
    case StartKind::none:
      break;
  }
  return rest - 2 * along * start.axis;
}

/// Initial positions and velocities of the owned nodes.
void set_initial_state(SimulationDefinition& definition, const DistributedMesh& mesh,
                       const SceneConfig& scene, std::span<const BodyRange> bodies) {
  const auto owned = static_cast<std::size_t>(mesh.owned_nodes);
  for (std::size_t i = 0; i < owned; ++i) {
    const auto node = mesh.original_nodes[i];
    const auto range =
        std::find_if(bodies.begin(), bodies.end(), [node](const auto& body) { return node < body.end_node; });
    const auto& body = scene.bodies[static_cast<std::size_t>(range - bodies.begin())];
    auto x = mesh.rest_positions[i];
    if (body.start) {
      const auto target = start_target(*body.start, *range, x, node - range->first_node);
      x = (1 - body.start->amplitude) * x + body.start->amplitude * target;
    }
    definition.initial_positions.push_back(x);
    definition.initial_velocities.push_back(body.velocity + cross(body.spin, x - range->center_of_volume));
  }
}

/// Applies an event to a scene of its own and to the simulation.
TimedEvent timed_event(const EventConfig& event, const std::shared_ptr<SceneConfig>& scene,
                       std::span<const int> region_body, std::span<const int> region_group) {
  std::vector<std::pair<int, int>> regions;
  for (std::size_t r = 0; r < region_body.size(); ++r) regions.emplace_back(region_body[r], region_group[r]);
  return {event.at, [event, scene, regions](Simulation& simulation) {
            apply_event(*scene, event);
            if (event.target == EventTarget::gravity) {
              simulation.set_gravity(scene->gravity);
            } else if (event.target == EventTarget::friction) {
              const auto& obstacle = scene->obstacles[event.owner];
              simulation.set_friction(obstacle.name, obstacle.friction);
            } else {
              for (std::size_t r = 0; r < regions.size(); ++r)
                if (regions[r].first == static_cast<int>(event.owner))
                  simulation.set_properties(static_cast<std::int32_t>(r),
                                            properties_of(scene->bodies[event.owner], regions[r].second));
            }
          }};
}

/// Of the muscle in each region that has a say in it.
std::vector<Activation> activations_of(const SceneConfig& scene, std::span<const int> region_body,
                                       std::span<const int> region_group) {
  std::vector<Activation> all;
  for (std::size_t r = 0; r < region_body.size(); ++r) {
    const auto& body = scene.bodies[static_cast<std::size_t>(region_body[r])];
    const auto* group =
        region_group[r] < 0 ? nullptr : &body.groups[static_cast<std::size_t>(region_group[r])];
    const auto& keys = group != nullptr && group->activation ? group->activation : body.activation;
    if (!keys || !std::holds_alternative<Muscle>(properties_of(body, region_group[r]).material)) continue;
    all.push_back({static_cast<std::int32_t>(r), {}});
    for (const auto& key : *keys) all.back().keyframes.push_back({key.time, key.value});
  }
  return all;
}

void broadcast(MPI_Comm comm, std::vector<int>& values) {
  int size = static_cast<int>(values.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  values.resize(static_cast<std::size_t>(size));
  MPI_Bcast(values.data(), size, MPI_INT, 0, comm);
}

/// Rank 0's body ranges to all; the names are known from the scene.
void broadcast(MPI_Comm comm, std::vector<BodyRange>& bodies, const SceneConfig& scene) {
  bodies.resize(scene.bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    auto& body = bodies[b];
    body.name = scene.bodies[b].name;
    std::array<GlobalIndex, 2> nodes{body.first_node, body.end_node};
    MPI_Bcast(nodes.data(), 2, MPI_INT64_T, 0, comm);
    body.first_node = nodes[0];
    body.end_node = nodes[1];
    for (auto* vector : {&body.lower, &body.upper, &body.center_of_volume})
      MPI_Bcast(vector->components.data(), 3, MPI_DOUBLE, 0, comm);
  }
}

}  // namespace

ElasticProperties properties_of(const BodyConfig& body, int group) {
  auto density = body.density;
  auto material = body.material;
  auto damping = body.damping;
  auto plasticity = body.plasticity;
  if (group >= 0) {
    const auto& own = body.groups[static_cast<std::size_t>(group)];
    density = own.density.value_or(density);
    material = own.material.value_or(material);
    if (own.damping) damping = own.damping;
    if (own.plasticity) plasticity = own.plasticity;
  }
  return {density,
          material_of(material),
          damping_of(damping, material),
          body.precision,
          mass_damping_of(damping),
          plasticity_of(plasticity, material),
          body.mean_dilatation};
}

BuiltScene build_scene(MPI_Comm comm, const SceneConfig& scene) {
  const StageScope stage(Stage::setup);
  const PhaseScope phase(Phase::setup);
  SceneMesh whole;
  on_root(comm, [&] { whole = build_scene_mesh(scene); });
  broadcast(comm, whole.region_body);
  broadcast(comm, whole.region_group);
  broadcast(comm, whole.bodies, scene);
  auto mesh = distribute(comm, whole.mesh);

  SimulationDefinition definition;
  for (std::size_t r = 0; r < whole.region_body.size(); ++r)
    definition.properties.push_back(
        properties_of(scene.bodies[static_cast<std::size_t>(whole.region_body[r])], whole.region_group[r]));
  definition.obstacles = make_obstacles(comm, scene);
  for (std::size_t c = 0; c < scene.constraints.size(); ++c)
    definition.prescribed.push_back(prescribed_of(scene.constraints[c], mesh.node_sets[c]));
  definition.goals = flow_goals(mesh, scene, whole);
  definition.activations = activations_of(scene, whole.region_body, whole.region_group);
  const auto changing = std::make_shared<SceneConfig>(scene);
  for (const auto& event : scene.events)
    definition.events.push_back(timed_event(event, changing, whole.region_body, whole.region_group));
  definition.gravity = scene.gravity;
  set_initial_state(definition, mesh, scene, whole.bodies);
  definition.method = scene.integrator.method;
  definition.mass = scene.integrator.mass;
  definition.quasistatic = scene.integrator.quasistatic;
  definition.fixed_time_step = scene.integrator.time_step.value_or(0);
  definition.time_step = {scene.integrator.safety, scene.integrator.max_strain_increment};
  if (scene.filter)
    definition.filter = {.time_step = scene.filter->time_step.value_or(0),
                         .safety = scene.filter->safety,
                         .selection = scene.filter->selection,
                         .most_softened = scene.filter->most_softened,
                         .constraints = scene.filter->constraints,
                         .projection = scene.filter->projection,
                         .projection_sweeps = scene.filter->projection_sweeps};
  return {std::make_unique<Simulation>(std::move(mesh), std::move(definition)), std::move(whole.bodies)};
}

}  // namespace evert
