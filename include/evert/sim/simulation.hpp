#pragma once
#include "evert/integrators/integrator.hpp"
#include "evert/math/vec3.hpp"
#include "evert/mesh/distributed_mesh.hpp"
#include "evert/sim/definition.hpp"
#include "evert/sim/soundness.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace evert {

/// Sums over all ranks at the present state, SI units; rigid bodies with a mass count like the others.
struct Measurements {
  double kinetic_energy = 0;
  double elastic_energy = 0;
  double gravitational_energy = 0;
  double plastic_work = 0;  ///< that has gone into plastic flow since the start, ≥ 0
  double control_work = 0;  ///< of the control of flow on the elastic energy since the start
  double goal_distance =
      0;  ///< rms of log S − that of its goal, over the rms of the latter, S the stretch of F_p [-]
  Vec3d momentum{};
  Vec3d angular_momentum{};         ///< about the origin
  Vec3d gravity_impulse{};          ///< accumulated since the start [N s]
  Vec3d contact_impulse{};          ///< from obstacles without a mass, accumulated since the start [N s]
  Vec3d constraint_impulse{};       ///< from fixed and scripted nodes, accumulated since the start [N s]
  Vec3d damping_impulse{};          ///< of mass-proportional damping, accumulated since the start [N s]
  GlobalIndex inverted_points = 0;  ///< quadrature points with det F < 0; a tet4 has one

  [[nodiscard]] double total_energy() const { return kinetic_energy + elastic_energy + gravitational_energy; }
};

/// The nodal values that a checkpoint keeps, 3 per owned node. They are views: of the simulation that gave
/// them, or of whatever else holds them.
struct NodeState {
  std::span<const double> positions;         ///< [m]
  std::span<const double> velocities;        ///< [m/s]
  std::span<const double> velocity_changes;  ///< System::v_change [m/s]
};

/// What the cells of each entry of DistributedMesh::cells remember of their flow, see ElasticForces::flow;
/// empty where they cannot flow.
using FlowState = std::vector<std::vector<double>>;

/// A value that a checkpoint keeps besides those; restored bit by bit.
using StateScalar = std::pair<std::string, double>;

/// Owns everything that moves; one call advances it. All calls are collective unless said otherwise.
class Simulation {
 public:
  /// Throws UserError for a definition that cannot be.
  Simulation(DistributedMesh mesh, SimulationDefinition definition);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Advances by `dt` [s]. Throws SimulationError, on all ranks and with the time in it, when a solve does
  /// not converge, when afterwards a position is not finite or a velocity not below that of light, when
  /// velocities explode (GrowthWatch), and when `dt` is lost in the rounding of the time; with where, why and
  /// what to try. The state is then that of a broken step: good for nothing.
  StepReport step(double dt);
  /// The same to exactly `end_time` [s], in one step.
  StepReport step_to(double end_time);
  /// The largest step that is stable and accurate now [s], infinity where nothing limits it (as in a
  /// quasistatic simulation), with a filter at most the step that it filters for; the fixed step where the
  /// scene names one.
  [[nodiscard]] double suggested_time_step();
  /// The time of the next event or keyframe of an activation [s], or infinity. Not collective.
  [[nodiscard]] double next_event() const;

  /// True where the steps are states of rest.
  [[nodiscard]] bool quasistatic() const { return std::holds_alternative<Quasistatic>(integrator_); }

  /// True where a step solves for velocities: with damping implicit, or consistent masses.
  [[nodiscard]] bool solves_for_velocities() const {
    return std::holds_alternative<Newmark>(integrator_) && elastic_.couples_velocities();
  }

  /// True where the motion seems to begin to explode: no state to go on from.
  [[nodiscard]] bool suspicious() { return soundness_.suspicious(system_); }

  /// Throws SimulationError with the time, `what`, and what may help. Not collective; for all ranks together.
  [[noreturn]] void give_up(const std::string& what) const;

  /// Not collective: any rank may ask. StepReport::stop_requested of the next step tells all of them; the
  /// wish travels with what each step reduces anyway.
  void request_stop() { stop_requested_ = true; }

  // Not collective:
  [[nodiscard]] const DistributedMesh& mesh() const { return mesh_; }
  [[nodiscard]] double time() const { return system_.time; }  ///< [s]
  [[nodiscard]] std::int64_t steps() const { return steps_; }
  [[nodiscard]] const NodeField& positions() const { return system_.x; }   ///< [m]
  [[nodiscard]] const NodeField& velocities() const { return system_.v; }  ///< [m/s]
  [[nodiscard]] const ElasticForces& elastic() const { return elastic_; }
  /// Null: none.
  [[nodiscard]] const ModalFilter* filter() const { return filter_.get(); }
  /// Of a compliant filter; null: none.
  [[nodiscard]] const ImplicitStrains* implicit_strains() const { return implicit_strains_.get(); }
  /// Of a filter with `paper` constraints; null: none.
  [[nodiscard]] const ShapeProjection* projection() const { return projection_.get(); }
  /// Smallest signed principal stretch per owned cell, of the elastic deformation where it can flow, `block`
  /// counting as in DistributedMesh::cells.
  void min_stretch(std::size_t block, std::span<double> per_cell) const;

  /// Sums over all ranks of energies, momenta and impulses.
  [[nodiscard]] Measurements measure() const;
  /// Quadrature points with det F < 0, over all ranks.
  [[nodiscard]] GlobalIndex inverted_points() const;

  /// Not collective.
  [[nodiscard]] std::span<const std::unique_ptr<Obstacle>> obstacles() const {
    return collisions_.obstacles();
  }
  /// What each obstacle gave to nodes and to rigid bodies since the start, summed over all ranks.
  [[nodiscard]] std::vector<ObstacleImpulse> obstacle_impulses() const;

  // What events may change. Not collective; the forces follow before the next step.
  void set_properties(std::int32_t region, const ElasticProperties& properties);
  void set_gravity(const Vec3d& gravity);
  /// `obstacle` must exist.
  void set_friction(const std::string& obstacle, double coefficient);

  [[nodiscard]] NodeState node_state() const;
  [[nodiscard]] FlowState flow_state() const;
  /// All other state (time, steps, step control, impulses). Impulses are summed over ranks.
  [[nodiscard]] std::vector<StateScalar> state_scalars() const;
  /// Replaces the whole state, by what node_state(), flow_state() and state_scalars() gave. Events up to the
  /// restored time are applied. Throws UserError when a scalar is missing.
  void restore(const NodeState& nodes, std::span<const StateScalar> scalars, const FlowState& flow = {});

 private:
  void apply_due_events();
  void refresh_forces();
  /// Collective. Filters anew what has flown.
  void follow_flow();
  /// Gives muscle the activation that it has at `time` [s], for the forces to be computed next.
  void activate(double time);
  /// Gives it the highest that it will have from now to `until` [s], for a bound.
  void activate_highest(double until);
  /// True when muscle may become much stiffer within `duration` [s].
  [[nodiscard]] bool activation_rises(double duration) const;
  StepReport advance(double dt);
  /// After a step of `dt` [s], or 0 at a start. True when any rank has called request_stop. Throws
  /// SimulationError when any rank's state is not sound.
  bool agree_on_state(double dt);
  /// "at t = 0.1 s, step 12: ", for messages.
  [[nodiscard]] std::string moment() const;

  DistributedMesh mesh_;
  ElasticForces elastic_;
  std::unique_ptr<ModalFilter> filter_;
  std::unique_ptr<ImplicitStrains> implicit_strains_;  // with a compliant filter
  std::unique_ptr<ShapeProjection> projection_;        // with one of `paper` constraints
  Collisions collisions_;
  RigidDynamics rigid_;
  PrescribedMotion prescribed_;
  System system_;
  Integrator integrator_;
  double fixed_time_step_;
  TimeStepControl time_step_;
  Soundness soundness_;
  std::vector<Activation> activations_;
  std::vector<TimedEvent> events_;
  std::size_t events_done_ = 0;
  std::int64_t steps_ = 0;
  bool forces_stale_ = false;
  bool stop_requested_ = false;
  System::Impulses impulses_before_{};  // of all ranks, before a restart
  std::vector<ObstacleImpulse> obstacle_impulses_before_;
};

}  // namespace evert
