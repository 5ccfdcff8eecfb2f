#pragma once
#include "evert/integrators/equilibrium_solver.hpp"
#include "evert/integrators/step_report.hpp"
#include "evert/integrators/system.hpp"

#include <limits>

namespace evert {

/// From one state of rest to the next: time only says which loads and positions are prescribed. Velocities
/// are zero; damping, inertia and obstacles take no part.
///
/// What has changed since the last state, of whatever kind (loads, materials, prescribed positions), is
/// applied in parts: a part in which the solver does not converge is halved. Where elements are inverted at
/// rest, states of less energy are looked for around them.  docs/design/quasistatic.md
class Quasistatic {
 public:
  /// c of the others: no step is too large.
  static constexpr double stability_constant = std::numeric_limits<double>::infinity();

  /// Collective.
  Quasistatic(const System& system, const QuasistaticOptions& options);

  /// Collective. Takes x to the state of rest at the time in `dt` [s], f and the time along. Throws
  /// SimulationError when even the smallest part does not converge.
  StepReport advance(System& system, double dt);

  /// States of rest may be as far apart in time as one likes [s].
  [[nodiscard]] static double stable_step(const System& /*system*/) {
    return std::numeric_limits<double>::infinity();
  }

 private:
  void untangle(System& system, double end, double load, StepReport& report);
  void count(const EquilibriumSolver::Outcome& outcome, StepReport& report) const;
  void account(System& system, double dt) const;

  QuasistaticOptions options_;
  EquilibriumSolver solver_;
  NodeField unbalanced_, withheld_;   // P f(x⁰) at the new loads, and the part not yet applied [N]
  NodeField reached_;                 // x of the last part that converged
  std::vector<NodeConstraint> held_;  // with the ways of the part
};

}  // namespace evert
