#pragma once
#include "evert/mesh/distributed_mesh.hpp"

#include <span>

namespace evert {

/// Collective. Root mean square distance [m] between the present shape of the nodes with original numbers in
/// [first, end) and their rest shape, after the best rigid motion (Kabsch, rotation by the rotation-variant
/// SVD: never a mirror image). Every node counts the same.
[[nodiscard]] double rms_shape_error(const DistributedMesh& mesh, const NodeField& positions,
                                     GlobalIndex first, GlobalIndex end);

}  // namespace evert
