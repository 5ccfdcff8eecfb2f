#pragma once
#include "evert/contact/collisions.hpp"
#include "evert/contact/prescribed_motion.hpp"
#include "evert/filter/modal_filter.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/integrators/method.hpp"
#include "evert/integrators/time_step.hpp"
#include "evert/sim/activation.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evert {

class Simulation;

/// A change that a scene makes at a time: of materials, gravity or friction. Ordered by time.
struct TimedEvent {
  double time = 0;  ///< [s]
  std::function<void(Simulation&)> apply;
};

/// What the flow of a region is led to.
struct FlowGoal {
  std::int32_t region = 0;
  std::string name;  ///< for messages
  PlasticControl control;
  /// Where the node of a cell is to be [m], see ElasticForces::set_goal.
  std::function<Vec3d(const DistributedMesh& mesh, std::size_t entry, LocalIndex cell, std::size_t node)>
      position;
};

/// Everything a simulation is made of, as values. Lists that the scene leaves empty stay empty.
struct SimulationDefinition {
  std::vector<ElasticProperties> properties;  ///< per entry of DistributedMesh::regions
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  std::vector<PrescribedNodes> prescribed;  ///< this rank's owned nodes
  std::vector<Activation> activations;      ///< of regions of muscle
  std::vector<FlowGoal> goals;              ///< of regions that flow
  std::vector<TimedEvent> events;
  Vec3d gravity{};                        ///< [m/s^2]
  BodyForce body_force;                   ///< besides gravity
  std::vector<Vec3d> initial_positions;   ///< per owned node [m]; empty: at rest shape
  std::vector<Vec3d> initial_velocities;  ///< per owned node [m/s]; empty: at rest
  IntegrationMethod method = IntegrationMethod::newmark;
  MassForm mass = MassForm::lumped;  ///< consistent: newmark only, without obstacles
  QuasistaticOptions quasistatic;    ///< of that method
  double fixed_time_step = 0;        ///< [s]; 0: chosen by TimeStepControl
  TimeStepOptions time_step;
  std::optional<ModalFilterOptions> filter;  ///< empty: no element is filtered
};

}  // namespace evert
