#pragma once
#include "evert/integrators/damping_solver.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

namespace evert {

/// Explicit Euler: the velocity of the beginning of the step moves the nodes. First order. It is there to be
/// compared with: in every step the energy of an undamped vibration grows by the factor 1 + (ωΔt)².
///
/// Largest stable step c/ω for a mode of frequency ω and damping ratio ξ:
///   undamped  c = 0
///   damped    c = 2 ξ up to ξ = 1, 2 (ξ − √(ξ² − 1)) beyond
/// docs/design/time-stepping.md
class ExplicitEuler {
 public:
  /// c: without damping, vibrations of frequency ω are stable up to ωΔt = c: none are.
  static constexpr double stability_constant = 0;

  /// Collective.
  explicit ExplicitEuler(const System& system);

  /// Collective. Advances x, v, f and the time by `dt` [s].
  StepReport advance(System& system, double dt);

  /// None is stable whatever the damping of the elements: 0.
  [[nodiscard]] static double stable_step(const System& /*system*/) { return 0; }

 private:
  DampingSolver solver_;  // of masses and constraints alone
  NodeField before_;      // the velocity that moves the nodes
  NodeField force_;       // f − C v [N]
  VecHandle right_;
};

}  // namespace evert
