#pragma once
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

namespace evert {

/// Symplectic Euler: the forces change the velocity, and that moves the nodes. First order; of an undamped
/// vibration it keeps an energy of its own, which differs from the true one by a share of ωΔt/2 that does not
/// grow. One evaluation of forces and one product with C a step, no solve.
///
/// Largest stable step c/ω for a mode of frequency ω and damping ratio ξ:
///   undamped  c = 2
///   damped    c = 2 (√(ξ² + 1) − ξ)
/// docs/design/time-stepping.md
class SymplecticEuler {
 public:
  /// c: without damping, vibrations of frequency ω are stable up to ωΔt = c.
  static constexpr double stability_constant = 2;

  /// Collective.
  explicit SymplecticEuler(const System& system);

  /// Collective. Advances x, v, f and the time by `dt` [s].
  StepReport advance(System& system, double dt);

  /// Collective. The largest step [s] that is stable at the present state, as far as this rank's elements
  /// say.
  [[nodiscard]] static double stable_step(const System& system);

 private:
  DampingSolver solver_;  // of masses and constraints alone
  NodeField scratch_;     // force, then the velocity that moves the nodes
  VecHandle right_;
};

}  // namespace evert
