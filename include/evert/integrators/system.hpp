#pragma once
#include "evert/contact/collisions.hpp"
#include "evert/contact/prescribed_motion.hpp"
#include "evert/contact/rigid_dynamics.hpp"
#include "evert/forces/body_force.hpp"
#include "evert/forces/elastic_forces.hpp"
#include "evert/integrators/implicit_strains.hpp"
#include "evert/integrators/shape_projection.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace evert {

/// What an integrator advances: the state, and references to everything that acts on it.
struct System {
  const DistributedMesh& mesh;
  ElasticForces& elastic;
  Collisions& collisions;
  RigidDynamics& rigid;
  PrescribedMotion& prescribed;
  Vec3d gravity;         ///< [m/s^2]
  BodyForce body_force;  ///< besides gravity; empty where there is none
  ImplicitStrains* implicit_strains =
      nullptr;  ///< of a compliant filter; null: all of the elasticity is explicit

  ShapeProjection* projection = nullptr;  ///< of a filter with `paper` constraints; null: none

  NodeField x;             ///< positions [m]; ghosts are up to date between steps
  NodeField v;             ///< velocities [m/s]
  NodeField v_change;      ///< what the last half step added to v: where the next solve looks first [m/s]
  NodeField f;             ///< elastic forces and weight at x, owned nodes [N]
  double time = 0;         ///< [s]
  double forces_time = 0;  ///< of the last update_forces() [s]: what may flow has had since then to
  std::uint64_t force_updates =
      0;  ///< counts update_forces(), so that what depends on C(x) knows when it is stale

  /// Impulses received since the start, this rank's share [N s].
  struct Impulses {
    Vec3d gravity{}, contact{}, constraint{};
    Vec3d damping{};  ///< of the damping proportional to mass; the other has no resultant
  } impulses;

  /// What each obstacle gave to nodes and rigid bodies since the start, this rank's share; the angular part
  /// about the origin of its frame at the time.
  std::vector<ObstacleImpulse> obstacle_impulses;

  System(const DistributedMesh& distributed, ElasticForces& elastic_forces, Collisions& node_collisions,
         RigidDynamics& rigid_dynamics, PrescribedMotion& prescribed_motion, const Vec3d& gravitation,
         BodyForce force = {}, ImplicitStrains* strains = nullptr);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  [[nodiscard]] std::span<const double> masses() const { return elastic.masses(); }
  [[nodiscard]] std::span<const double> mass_row_sums() const { return elastic.mass_row_sums(); }
  /// Collective. f = elastic forces at x and loads at `t` [s], and C(x); what yields at x flows. To be called
  /// whenever x, a material or gravity changes.
  void update_forces(double t);
  /// Collective. Before a solve of a step of `dt` [s] that starts from the present forces: brings
  /// implicit_strains up to date.
  void prepare_solve(double dt) const {
    if (implicit_strains != nullptr) implicit_strains->prepare(x, dt, force_updates);
  }
  /// Collective. At the beginning of a step of `dt` [s], and once nodes have moved, with `held` what holds
  /// them from then on: keeps the lengths of filtered elements. Returns the iterations that took.
  void begin_projection(double dt) {
    if (projection != nullptr) projection->begin(x, prescribed.at(time + dt));
  }
  int project(std::span<const NodeConstraint> held, double dt) {
    return projection != nullptr ? projection->project(x, v, held, dt) : 0;
  }
  /// Collective. Adds the weights and what the body force does at `t` [s] to `sum`, on owned nodes [N]: all
  /// that does not depend on x.
  void add_loads(double t, NodeField& sum) const;

 private:
  void add_body_load(double t, std::span<double> owned) const;
};

}  // namespace evert
