#include "components.hpp"

#include <numeric>

namespace evert {

std::vector<GlobalIndex> components_of_nodes(const Mesh& mesh) {
  std::vector<GlobalIndex> parent(mesh.nodes.size());
  std::iota(parent.begin(), parent.end(), GlobalIndex{0});
  const auto root = [&](GlobalIndex node) {
    auto at = static_cast<std::size_t>(node);
    while (parent[at] != static_cast<GlobalIndex>(at)) {
      parent[at] = parent[static_cast<std::size_t>(parent[at])];  // halves the path
      at = static_cast<std::size_t>(parent[at]);
    }
    return static_cast<GlobalIndex>(at);
  };
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t i = 0; i < block.nodes.size(); ++i)
      if (i % stride != 0) parent[static_cast<std::size_t>(root(block.nodes[i]))] = root(block.nodes[i - 1]);
  }
  for (std::size_t node = 0; node < parent.size(); ++node)
    parent[node] = root(static_cast<GlobalIndex>(node));
  return parent;
}

}  // namespace evert
