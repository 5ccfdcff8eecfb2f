#include "evert/mesh/distributed_mesh.hpp"

namespace evert {

NodeField::NodeField(const DistributedMesh& mesh)
    : array_(3 * static_cast<std::size_t>(mesh.local_nodes()) + 1),
      owned_nodes_(mesh.owned_nodes),
      local_nodes_(mesh.local_nodes()) {
  const std::vector<PetscInt> ghosts(mesh.ghost_globals.begin(), mesh.ghost_globals.end());
  check(VecCreateGhostBlockWithArray(mesh.comm, 3, 3 * PetscInt{mesh.owned_nodes}, PETSC_DECIDE,
                                     mesh.ghost_nodes, ghosts.data(), array_.data(), vec_.out()));
}

void NodeField::touched() {
  // The public way to increase the vector's state counter.
  PetscScalar* array = nullptr;
  check(VecGetArrayWrite(vec_.get(), &array));
  check(VecRestoreArrayWrite(vec_.get(), &array));
}

}  // namespace evert
