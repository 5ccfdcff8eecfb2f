#pragma once
#include "tests/support/scenes.hpp"

/// A ball that flies, spins and trembles, with nothing in its way.
namespace evert::test {

inline const std::string spinning_ball = R"(
name: free flight
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.25}
    density: 1000
    velocity: [0.3, -0.2, 0.1]
    spin: [1.0, 2.0, -1.5]
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
)";

/// Collective. Half of the undamped bound.
inline double half_stable_step(Simulation& simulation) {
  double step = 0.5 * simulation.elastic().stable_step(simulation.positions()).undamped;
  MPI_Allreduce(MPI_IN_PLACE, &step, 1, MPI_DOUBLE, MPI_MIN, simulation.mesh().comm);
  return step;
}

}  // namespace evert::test
