#include "evert/mesh/partition_quality.hpp"

#include "evert/core/error.hpp"

#include "dual_graph.hpp"
#include <algorithm>
#include <string>

namespace evert {
namespace {

void sort_unique(auto& values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
}

/// Nodes that the cells of each rank touch.
std::vector<GlobalIndex> count_nodes(const Mesh& mesh, std::span<const int> rank_of_cell, std::size_t ranks) {
  std::vector<std::vector<GlobalIndex>> nodes(ranks);
  std::size_t cell = 0;
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t first = 0; first < block.nodes.size(); first += stride, ++cell) {
      auto& of_rank = nodes[static_cast<std::size_t>(rank_of_cell[cell])];
      const auto begin = block.nodes.begin() + static_cast<std::ptrdiff_t>(first);
      of_rank.insert(of_rank.end(), begin, begin + static_cast<std::ptrdiff_t>(stride));
    }
  }
  std::vector<GlobalIndex> counts;
  for (auto& of_rank : nodes) {
    sort_unique(of_rank);
    counts.push_back(static_cast<GlobalIndex>(of_rank.size()));
  }
  return counts;
}

}  // namespace

PartitionQuality measure_partition(const Mesh& mesh, std::span<const int> rank_of_cell, int ranks) {
  EVERT_ASSERT(static_cast<GlobalIndex>(rank_of_cell.size()) == mesh.cell_count(),
               std::to_string(rank_of_cell.size()));
  PartitionQuality quality;
  quality.ranks.resize(static_cast<std::size_t>(ranks));
  const auto graph = dual_graph(mesh);
  const auto weights = cell_weights<GlobalIndex>(mesh);
  GlobalIndex total_work = 0;
  for (std::size_t cell = 0; cell < rank_of_cell.size(); ++cell) {
    auto& load = quality.ranks[static_cast<std::size_t>(rank_of_cell[cell])];
    ++load.cells;
    load.work += weights[cell];
    total_work += weights[cell];
    for (auto i = graph.offsets[cell]; i < graph.offsets[cell + 1]; ++i) {
      const int other = rank_of_cell[static_cast<std::size_t>(graph.neighbours[static_cast<std::size_t>(i)])];
      if (other == rank_of_cell[cell]) continue;
      ++load.cut_faces;
      load.neighbours.push_back(other);
    }
  }
  const auto nodes = count_nodes(mesh, rank_of_cell, quality.ranks.size());
  GlobalIndex most_work = 0;
  for (std::size_t rank = 0; rank < quality.ranks.size(); ++rank) {
    auto& load = quality.ranks[rank];
    load.nodes = nodes[rank];
    sort_unique(load.neighbours);
    quality.edge_cut += load.cut_faces;
    most_work = std::max(most_work, load.work);
  }
  quality.edge_cut /= 2;  // each face was met from both sides
  if (total_work > 0)
    quality.imbalance = static_cast<double>(most_work) * ranks / static_cast<double>(total_work);
  return quality;
}

}  // namespace evert
