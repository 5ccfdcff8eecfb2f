#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <string>

namespace evert {

Halo::Halo(const DistributedMesh& mesh)
    : local_values_(3 * static_cast<std::size_t>(mesh.local_nodes())), alone_(size_of(mesh.comm) == 1) {}

void Halo::check_belongs(const NodeField& field) const {
  EVERT_ASSERT(field.local().size() == local_values_, "a field of " + std::to_string(field.local().size()) +
                                                          " local values in a halo of " +
                                                          std::to_string(local_values_));
}

void Halo::begin_update(NodeField& field) const {
  check_belongs(field);
  if (alone_) return;
  const PhaseScope scope(Phase::halo);
  check(VecGhostUpdateBegin(field.vec(), INSERT_VALUES, SCATTER_FORWARD));
}

void Halo::end_update(NodeField& field) const {
  if (alone_) return;
  const PhaseScope scope(Phase::halo);
  check(VecGhostUpdateEnd(field.vec(), INSERT_VALUES, SCATTER_FORWARD));
}

void Halo::begin_add(NodeField& field) const {
  check_belongs(field);
  if (alone_) return;
  const PhaseScope scope(Phase::halo);
  check(VecGhostUpdateBegin(field.vec(), ADD_VALUES, SCATTER_REVERSE));
}

void Halo::end_add(NodeField& field) const {
  if (alone_) return;
  const PhaseScope scope(Phase::halo);
  check(VecGhostUpdateEnd(field.vec(), ADD_VALUES, SCATTER_REVERSE));
}

}  // namespace evert
