#pragma once
#include "evert/mesh/distributed_mesh.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"

#include <string>
#include <vector>

/// Simulations for tests, from YAML as a user would write it.
namespace evert::test {

/// Collective over `comm`.
inline BuiltScene build(const std::string& yaml, const std::vector<std::string>& overrides = {},
                        MPI_Comm comm = PETSC_COMM_WORLD) {
  return build_scene(comm, parse_scene(yaml, "test.yaml", overrides));
}

/// Collective. x y z of all nodes in the order of the undistributed mesh, on every rank.
inline std::vector<double> gathered(const DistributedMesh& mesh, const NodeField& field) {
  std::vector<double> all(3 * static_cast<std::size_t>(mesh.total_nodes));
  for (std::size_t i = 0; i < field.owned().size(); ++i)
    all[3 * static_cast<std::size_t>(mesh.original_nodes[i / 3]) + i % 3] = field.owned()[i];
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return all;
}

/// Collective. These positions after steps of the length that the simulation suggests.
inline std::vector<double> after_steps(Simulation& simulation, int steps) {
  for (int step = 0; step < steps; ++step) simulation.step(simulation.suggested_time_step());
  return gathered(simulation.mesh(), simulation.positions());
}

/// Largest difference of two arrays.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return a.size() == b.size() ? largest : std::numeric_limits<double>::infinity();
}

}  // namespace evert::test
