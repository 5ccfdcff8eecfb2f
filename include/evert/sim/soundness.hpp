#pragma once
#include "evert/integrators/system.hpp"
#include "evert/sim/energy_watch.hpp"
#include "evert/sim/growth_watch.hpp"

#include <string>

namespace evert {

/// What is the matter with a state.
enum class Ailment { none, unsound_nodes, unsound_rigid_body, explosion, energy };

/// Looks at the state after every step: one pass over the nodes and one reduction, and no memory is taken.
class Soundness {
 public:
  /// `closed` as in EnergyWatch.
  Soundness(const DistributedMesh& mesh, bool closed)
      : watch_(static_cast<std::size_t>(mesh.owned_nodes)), energy_(closed) {}

  struct Findings {
    Ailment ailment = Ailment::none;
    GlobalIndex unsound_nodes = 0;
    std::size_t obstacle = 0;  ///< number of the rigid body
    bool stop = false;         ///< some rank wants to stop
  };

  /// Collective. After a step of `dt` [s], or 0 at a start. The same on every rank.
  [[nodiscard]] Findings look(const System& system, double dt, bool stop_requested);
  /// The state, or what it is made of, was replaced.
  void forget() {
    watch_.forget();
    energy_.forget();
  }
  /// Collective. The motion seems to begin to explode.
  [[nodiscard]] bool suspicious(const System& system) {
    return watch_.suspicious() || energy_.is_growing(system);
  }
  [[nodiscard]] const GrowthWatch& watch() const { return watch_; }
  [[nodiscard]] const EnergyWatch& energy() const { return energy_; }

 private:
  GrowthWatch watch_;
  EnergyWatch energy_;
};

/// Where it is worst: the node that is not finite, else the fastest.
struct WorstNode {
  GlobalIndex node = 0;  ///< number in the undistributed mesh
  GlobalIndex cell = 0;  ///< one that it is a corner of
  std::string region;    ///< of that cell
  int rank = 0;
  double speed = 0;  ///< [m/s]; may not be finite
};

/// Collective.
[[nodiscard]] WorstNode worst_node(const System& system);

}  // namespace evert
