#pragma once
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/rigid_coupling.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace evert {

/// Newmark's scheme with elastic forces explicit and damping forces implicit; second order, variable step.
/// paper A, section 9; PHYSICS 5
///
/// Largest stable step for a mode of frequency ω and damping ratio ξ: 2(√(ξ²+1)+ξ)/ω.
class Newmark {
 public:
  /// Collective.
  explicit Newmark(const System& system);

  /// Collective. Advances x, v, f and the time by `dt` [s]. Throws SimulationError when a solve does not
  /// converge.
  StepReport advance(System& system, double dt);

 private:
  /// What holds nodes of any rank in a step.
  struct Held {
    bool colliding = false;
    bool prescribed = false;
  };
  void take_momentum_and_half_impulse(const System& system, double dt);
  int predict(System& system, double dt);
  Held collide(System& system, double dt);
  int correct(System& system, double dt, bool colliding);
  int rub(System& system);
  int couple(System& system);
  void remember_change(System& system, std::span<const double> after, std::span<const double> before) const;
  static void account_for_obstacles(System& system, double dt);
  static void account_for_mass_damping(System& system, double dt);
  void follow_forces(const System& system);

  DampingSolver solver_;
  NodeField predicted_;  // ṽ at the middle of the step
  VecHandle right_;
  std::optional<RigidCoupling> coupling_;       // where a rigid body has a mass
  double implicit_ = 0;                         // s of the last velocity solve, M + s C [s]
  std::span<const NodeConstraint> prescribed_;  // at the end of the step; system.prescribed owns them
  std::vector<NodeConstraint> constraints_;     // those and the normals of colliding nodes
  std::uint64_t forces_seen_ = 0;
};

}  // namespace evert
