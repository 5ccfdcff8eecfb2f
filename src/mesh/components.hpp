#pragma once
#include "evert/mesh/mesh.hpp"

#include <vector>

namespace evert {

/// Sets of cells that share no node with the others: per node a node that stands for its set.
[[nodiscard]] std::vector<GlobalIndex> components_of_nodes(const Mesh& mesh);

}  // namespace evert
