#pragma once
#include "evert/io/natural_order.hpp"
#include "evert/mesh/distributed_mesh.hpp"
#include "evert/sim/simulation.hpp"

#include <span>
#include <string>
#include <vector>

/// Checkpoints: everything a run needs to go on, bit by bit, on any number of ranks.
namespace evert {

/// What a checkpoint brings back, in this rank's order.
struct CheckpointState {
  std::vector<double> positions, velocities, velocity_changes;  ///< see NodeState
  FlowState flow;
  std::vector<StateScalar> scalars;

  [[nodiscard]] NodeState nodes() const { return {positions, velocities, velocity_changes}; }
};

/// Writes checkpoints of one run to one file. A new one is completed under a temporary name, brought to the
/// disk and renamed: whenever the run dies, the file is the last complete checkpoint. Every call is
/// collective; what cannot be written is a UserError on all ranks and leaves the last checkpoint as it was.
class CheckpointWriter {
 public:
  /// `fingerprint` tells this scene from others. `mesh` must outlive the writer.
  CheckpointWriter(const DistributedMesh& mesh, std::string path, std::string fingerprint);

  /// The scalars are the same on all ranks.
  void write(const NodeState& nodes, std::span<const StateScalar> scalars, const FlowState& flow = {}) const;

 private:
  void write_file(const std::string& path, const NodeState& nodes, const FlowState& flow,
                  std::span<const StateScalar> scalars) const;

  const DistributedMesh& mesh_;
  std::string path_;
  std::string fingerprint_;
  std::uint64_t mesh_digest_;
  NaturalOrder order_;
  NaturalOrder cells_;
};

/// Collective. Reads a checkpoint of the scene and mesh, written on any number of ranks. Throws UserError on
/// all ranks when there is none, when the file is something else, truncated or damaged, or belongs to another
/// scene or mesh.
[[nodiscard]] CheckpointState read_checkpoint(const DistributedMesh& mesh, const std::string& path,
                                              const std::string& fingerprint);

}  // namespace evert
