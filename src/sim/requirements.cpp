#include "requirements.hpp"

#include "evert/core/error.hpp"

#include <algorithm>

namespace evert {
namespace {

/// Throws UserError where tangents are asked for that nobody computes.
void require_known_tangents(const SimulationDefinition& definition) {
  if (definition.method == IntegrationMethod::quasistatic &&
      std::ranges::any_of(definition.properties, &ElasticProperties::mean_dilatation))
    throw UserError("mean_dilatation: does not go with 'integrator.method: quasistatic'");
}

/// Throws UserError where flow and the way to advance do not go together.
void require_steps_that_flow(const SimulationDefinition& definition) {
  const bool flows = std::ranges::any_of(
      definition.properties, [](const auto& of_region) { return of_region.plasticity.has_value(); });
  if (!flows) return;
  if (definition.method == IntegrationMethod::quasistatic)
    throw UserError("plasticity: flow needs time, which 'integrator.method: quasistatic' has none of");
}

}  // namespace

MassForm possible_mass(const SimulationDefinition& definition) {
  require_steps_that_flow(definition);
  require_known_tangents(definition);
  if (definition.mass == MassForm::consistent &&
      (!definition.obstacles.empty() || definition.method != IntegrationMethod::newmark))
    throw UserError(
        "consistent masses go neither with obstacles nor with methods but newmark: must be lumped");
  return definition.mass;
}

std::vector<std::unique_ptr<Obstacle>> possible_obstacles(SimulationDefinition& definition) {
  const bool solves = definition.method != IntegrationMethod::symplectic_euler &&
                      definition.method != IntegrationMethod::explicit_euler;
  for (const auto& obstacle : definition.obstacles)
    if (!solves && obstacle->body() != nullptr)
      throw UserError("'" + obstacle->name() + "': a rigid body with a mass needs newmark or verlet");
  return std::move(definition.obstacles);
}

}  // namespace evert
