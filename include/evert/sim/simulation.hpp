#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "evert/math/vec3.hpp"
#include "evert/mesh/distributed_mesh.hpp"

namespace evert {

/// What one step did.
struct StepReport {
  double dt = 0;            ///< [s]
  int cg_iterations = 0;    ///< over the damping solves of the step
  LocalIndex contacts = 0;  ///< colliding owned nodes on this rank
};

/// Sums over all ranks at the present state, SI units.
struct Measurements {
  double kinetic_energy = 0;
  double elastic_energy = 0;
  double gravitational_energy = 0;
  Vec3d momentum{};
  Vec3d angular_momentum{};   ///< about the origin
  Vec3d gravity_impulse{};    ///< accumulated since the start [N s]
  Vec3d contact_impulse{};    ///< from obstacles, normal and friction, accumulated since the start [N s]
  Vec3d constraint_impulse{}; ///< from fixed and scripted nodes, accumulated since the start [N s]
  GlobalIndex inverted_points = 0;  ///< quadrature points with det F < 0; a tet4 has one
};

/// A value that a checkpoint keeps besides positions and velocities; restored bit by bit.
using StateScalar = std::pair<std::string, double>;

class SimulationParts;

/// Owns everything that moves; one call advances it. All calls are collective unless said otherwise.
class Simulation {
 public:
  explicit Simulation(std::unique_ptr<SimulationParts> parts);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Advances by `dt` [s]. Throws SimulationError when a value is not finite or a solve does not converge.
  StepReport step(double dt);
  /// The largest step that is stable and accurate now [s]; the fixed step where the scene names one.
  [[nodiscard]] double suggested_time_step();

  // Not collective:
  [[nodiscard]] const DistributedMesh& mesh() const;
  [[nodiscard]] double time() const;  ///< [s]
  [[nodiscard]] std::int64_t steps() const;
  [[nodiscard]] const NodeField& positions() const;   ///< [m]
  [[nodiscard]] const NodeField& velocities() const;  ///< [m/s]
  /// Smallest signed principal stretch per owned cell, `block` counting as in DistributedMesh::cells.
  void min_stretch(std::size_t block, std::span<double> per_cell) const;

  [[nodiscard]] Measurements measure() const;

  /// All state besides positions and velocities (time, steps, step control, impulses, events done).
  [[nodiscard]] std::vector<StateScalar> state_scalars() const;
  /// Replaces the whole state: owned positions and velocities (3 per owned node) and the scalars of state_scalars().
  void restore(std::span<const double> positions, std::span<const double> velocities,
               std::span<const StateScalar> scalars);

 private:
  std::unique_ptr<SimulationParts> parts_;
};

}  // namespace evert
