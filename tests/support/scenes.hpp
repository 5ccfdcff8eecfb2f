#pragma once
#include "evert/mesh/distributed_mesh.hpp"
#include "evert/scene/build.hpp"
#include "evert/scene/load.hpp"

#include <cmath>
#include <limits>
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

/// Collective. To `end` [s] in equal steps as long as the simulation suggests.
inline double run_until(Simulation& simulation, double end) {
  while (simulation.time() < end) {
    const double left = end - simulation.time();
    const double steps = std::ceil(left / simulation.suggested_time_step() - 1e-9);
    steps <= 1 ? simulation.step_to(end) : simulation.step(left / steps);
  }
  return simulation.time();
}

/// What a checkpoint holds of a simulation.
class KeptState {
 public:
  explicit KeptState(const Simulation& simulation)
      : scalars_(simulation.state_scalars()), flow_(simulation.flow_state()) {
    const auto [x, v, changes] = simulation.node_state();
    x_.assign(x.begin(), x.end());
    v_.assign(v.begin(), v.end());
    changes_.assign(changes.begin(), changes.end());
  }
  void restore(Simulation& simulation) const { simulation.restore({x_, v_, changes_}, scalars_, flow_); }

 private:
  std::vector<double> x_, v_, changes_;
  std::vector<StateScalar> scalars_;
  FlowState flow_;
};

/// Largest difference of two arrays.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return a.size() == b.size() ? largest : std::numeric_limits<double>::infinity();
}

}  // namespace evert::test
