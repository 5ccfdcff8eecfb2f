#pragma once
#include "evert/materials/lame.hpp"
#include "evert/mesh/generators.hpp"

#include <mpi.h>

/// A cantilever of small deflection: what a mesh of it says, and what beam theory does.
namespace evert::bench {

/// Along x from 0, square across, held at x = 0 so that it cannot turn there, its weight along −z.
struct Beam {
  double length = 1;  ///< [m]
  double height = 0.1;
  double youngs_modulus = 1e6;  ///< [Pa]
  double poissons_ratio = 0.3;
  double density = 1000;  ///< [kg/m^3]
  double gravity = 0.1;   ///< [m/s^2]

  [[nodiscard]] Lame lame() const { return Lame::from_young_poisson(youngs_modulus, poissons_ratio); }
};

struct BeamAnswer {
  double tip_deflection = 0;  ///< [m] mean over the end
  double frequency = 0;       ///< [Hz] of the first bending vibration; 0 where it was not asked for
};

/// Timoshenko's theory, shear coefficient of Cowper 1966 for a rectangle.
[[nodiscard]] BeamAnswer timoshenko(const Beam& beam);

/// Collective. The linear equations of the mesh (looked at on rank 0 only), K u = M g and K φ = ω² M φ with
/// lumped masses. At rest the operator of `rotated` damping with α = λ and β = μ times a second is the
/// stiffness K, so that the solver of the damping does it, with its options.
[[nodiscard]] BeamAnswer solve_beam(MPI_Comm comm, const Mesh& mesh, const Beam& beam, bool with_frequency);

/// The beam filled with cubes cut into cells, `across` cubes across and 10 times as many along; with
/// `quadratic`, half as many, of tet10 with nodes at the same places (`across` even).
[[nodiscard]] Mesh beam_mesh(const Beam& beam, BoxCells cells, int across, bool quadratic = false);

}  // namespace evert::bench
