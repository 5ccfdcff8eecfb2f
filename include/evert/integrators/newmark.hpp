#pragma once
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/held_nodes.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

#include <cstdint>
#include <span>

namespace evert {

/// Newmark's scheme with elastic forces explicit and damping forces implicit; second order, variable step.
/// paper A, section 9; PHYSICS 5
///
/// Largest stable step for a mode of frequency ω and damping ratio ξ: 2(√(ξ²+1)+ξ)/ω.
class Newmark {
 public:
  /// c: without damping, vibrations of frequency ω are stable up to ωΔt = c.
  static constexpr double stability_constant = 2;

  /// Collective.
  explicit Newmark(const System& system);

  /// Collective. Advances x, v, f and the time by `dt` [s]. Throws SimulationError when a solve does not
  /// converge.
  StepReport advance(System& system, double dt);

  /// Collective. The largest step [s] that is stable at the present state, as far as this rank's elements
  /// say.
  [[nodiscard]] static double stable_step(const System& system);

 private:
  void take_momentum_and_half_impulse(const System& system, double dt);
  int predict(System& system, double dt);
  int correct(System& system, double dt, bool colliding);
  void remember_change(System& system, std::span<const double> after, std::span<const double> before) const;
  void follow_forces(const System& system);

  DampingSolver solver_;
  HeldNodes held_;
  NodeField predicted_;  // ṽ at the middle of the step
  VecHandle right_;
  double implicit_ = 0;  // s of the last velocity solve, M + s C [s]
  std::uint64_t forces_seen_ = 0;
};

}  // namespace evert
