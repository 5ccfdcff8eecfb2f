#pragma once
#include "evert/filter/mass_scaled_stiffness.hpp"

#include <vector>

namespace evert {

/// The largest eigenvalue of a matrix and its vector, of length 1.
struct FastestMode {
  double squared_frequency = 0;  ///< ω² [1/s²]
  VecHandle scaled;              ///< M^½ u, u the displacements
};

/// Collective. The largest eigenvalue of the stiffness, to `tolerance` of itself, by SLEPc's Krylov-Schur
/// with option prefix `stability_`. Throws UserError for an option that PETSc refuses, SimulationError when
/// the solve does not converge. All entries must be finite.
[[nodiscard]] FastestMode fastest_mode(const MassScaledStiffness& stiffness, double tolerance = 1e-9);

/// Collective. What `steps` steps of Lanczos from a fixed start find of the largest eigenvalue: never more
/// than it, and within a per cent after some twenty. An estimate, no bound.  PHYSICS 9
[[nodiscard]] double lanczos_estimate(const MassScaledStiffness& stiffness, int steps = 20);

/// Collective. What `steps` steps of Lanczos from a fixed start find of the modes above `squared_frequency`
/// [1/s²]: vectors whose Rayleigh quotient is above it, of length 1 and orthogonal, the fastest first. None
/// where none of the modes is above; with few steps some may be missed.
[[nodiscard]] std::vector<FastestMode> modes_above(const MassScaledStiffness& stiffness,
                                                   double squared_frequency, int steps);

}  // namespace evert
