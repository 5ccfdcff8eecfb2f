#pragma once
#include "evert/integrators/system.hpp"
#include "evert/sim/growth_watch.hpp"

#include <string>

namespace evert {

/// What is the matter with a state.
enum class Ailment { none, unsound_nodes, unsound_rigid_body, explosion };

/// Looks at the state after every step: one pass over the nodes and one reduction, no memory.
class Soundness {
 public:
  explicit Soundness(const DistributedMesh& mesh) : watch_(static_cast<std::size_t>(mesh.owned_nodes)) {}

  struct Findings {
    Ailment ailment = Ailment::none;
    GlobalIndex unsound_nodes = 0;
    std::size_t obstacle = 0;  ///< number of the rigid body
    bool stop = false;         ///< some rank wants to stop
  };

  /// Collective. The same on every rank.
  [[nodiscard]] Findings look(const System& system, bool stop_requested);
  /// The state was replaced.
  void forget() { watch_.forget(); }
  [[nodiscard]] const GrowthWatch& watch() const { return watch_; }

 private:
  GrowthWatch watch_;
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
