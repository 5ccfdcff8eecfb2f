#pragma once
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/held_nodes.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

namespace evert {

/// Velocity Verlet, the leapfrog scheme in the form kick, drift, kick, with elastic and damping forces
/// explicit; second order, also damped. One evaluation of forces and at most two products with C a step, no
/// solve.
///
/// Largest stable step c/ω for a mode of frequency ω and damping ratio ξ:
///   undamped  c = 2
///   damped    c = 2 (√(1 − 3ξ²) − ξ)/(1 − 4ξ²) up to ξ = 1/2, 1/ξ beyond
/// The latter is never less than 2 (√(ξ² + 1) − ξ), which `auto` takes.  docs/design/time-stepping.md
class Verlet {
 public:
  /// c: without damping, vibrations of frequency ω are stable up to ωΔt = c.
  static constexpr double stability_constant = 2;

  /// Collective.
  explicit Verlet(const System& system);

  /// Collective. Advances x, v, f and the time by `dt` [s].
  StepReport advance(System& system, double dt);

  /// Collective. The largest step [s] that is stable at the present state, as far as this rank's elements
  /// say.
  [[nodiscard]] static double stable_step(const System& system);

 private:
  void kick_and_drift(System& system, double dt);
  void kick(System& system, double dt);

  DampingSolver solver_;  // of masses and constraints alone
  HeldNodes held_;
  NodeField middle_;  // velocity at the middle of the step, then what is expected at its end
  NodeField force_;   // f − C v [N]
  VecHandle right_;
};

}  // namespace evert
