#include "components.hpp"

#include "evert/math/disjoint_sets.hpp"

namespace evert {

std::vector<GlobalIndex> components_of_nodes(const Mesh& mesh) {
  DisjointSets sets(mesh.nodes.size());
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t i = 0; i < block.nodes.size(); ++i)
      if (i % stride != 0)
        sets.join(static_cast<std::size_t>(block.nodes[i]), static_cast<std::size_t>(block.nodes[i - 1]));
  }
  std::vector<GlobalIndex> components(mesh.nodes.size());
  for (std::size_t node = 0; node < components.size(); ++node)
    components[node] = static_cast<GlobalIndex>(sets.root(node));
  return components;
}

}  // namespace evert
