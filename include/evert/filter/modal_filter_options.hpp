#pragma once
#include "evert/filter/filter_constraints.hpp"
#include "evert/filter/selection.hpp"

namespace evert {

struct ModalFilterOptions {
  double time_step = 0;  ///< [s] that steps may have; 0: chosen by choose_time_step()
  double safety =
      1.25;  ///< [-] ≥ 1: how much larger a step the filtered body takes at rest; strain stiffens it
  FilterSelection selection = FilterSelection::spare_mass;
  double most_softened = 0.05;  ///< [-] of the mass of any region, in cells filtered for a step chosen so
  FilterConstraints constraints = FilterConstraints::none;  ///< compliant: the integrator must take part
  FilterProjection projection = FilterProjection::shake;    ///< of `paper`
  int projection_sweeps = 0;      ///< of `paper`: most iterations a step; 0: until the lengths are kept
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
  /// What K_s is added to M with, in a step of `dt` [s], for its part of the stiffness to be as far below
  /// what is stable as the limit of the rest: θ Δt² with θ = (safety/c)² [s²].
  [[nodiscard]] double implicit_factor(double dt) const {
    const double time = safety * dt / stability_constant;
    return time * time;
  }
};

}  // namespace evert
