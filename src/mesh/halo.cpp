#include "evert/core/error.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <string>

namespace evert {

Halo::Halo(const DistributedMesh& mesh) : local_values_(3 * static_cast<std::size_t>(mesh.local_nodes())) {}

void Halo::check_belongs(const NodeField& field) const {
  EVERT_ASSERT(field.local().size() == local_values_, "a field of " + std::to_string(field.local().size()) +
                                                          " local values in a halo of " +
                                                          std::to_string(local_values_));
}

void Halo::begin_update(NodeField& field) const {
  check_belongs(field);
  check(VecGhostUpdateBegin(field.vec(), INSERT_VALUES, SCATTER_FORWARD));
}

void Halo::end_update(NodeField& field) const {
  check(VecGhostUpdateEnd(field.vec(), INSERT_VALUES, SCATTER_FORWARD));
}

void Halo::begin_add(NodeField& field) const {
  check_belongs(field);
  check(VecGhostUpdateBegin(field.vec(), ADD_VALUES, SCATTER_REVERSE));
}

void Halo::end_add(NodeField& field) const {
  check(VecGhostUpdateEnd(field.vec(), ADD_VALUES, SCATTER_REVERSE));
}

}  // namespace evert
