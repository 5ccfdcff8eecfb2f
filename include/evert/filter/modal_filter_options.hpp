#pragma once
#include "evert/filter/selection.hpp"

namespace evert {

struct ModalFilterOptions {
  double time_step = 0;  ///< [s] that steps may have; 0: chosen by choose_time_step()
  double safety =
      1.25;  ///< [-] ≥ 1: how much larger a step the filtered body takes at rest; strain stiffens it
  FilterSelection selection = FilterSelection::spare_mass;
  double most_softened = 0.05;    ///< [-] of the mass of any region, in cells filtered for a step chosen so
  double stability_constant = 2;  ///< c of the integrator: ωΔt ≤ c is stable without damping
  // What the body does without a filter:
  bool implicit_damping = false;   ///< the integrator takes it so, and makes larger steps with it
  double integrator_safety = 0.9;  ///< share of the stable step that it makes
  double fixed_time_step = 0;      ///< [s]; 0: chosen by the integrator

  [[nodiscard]] bool automatic() const { return time_step == 0; }
  /// (c/Δt)² that no squared frequency of the filtered body exceeds at rest [1/s²]; implicit damping only
  /// raises c.
  [[nodiscard]] double limit() const { return limit_of(time_step); }
  [[nodiscard]] double limit_of(double step) const {
    const double frequency = stability_constant / (safety * step);
    return frequency * frequency;
  }
};

}  // namespace evert
