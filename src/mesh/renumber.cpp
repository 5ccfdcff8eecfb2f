#include "renumber.hpp"

#include "evert/core/petsc.hpp"

#include <petscmat.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace evert {
namespace {

/// Calls `visit(cell nodes)` for every cell.
template <class Visit>
void for_each_cell(std::span<const LocalCells> cells, Visit&& visit) {
  for (const auto& block : cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t first = 0; first < block.nodes.size(); first += stride)
      visit(std::span(block.nodes).subspan(first, stride));
  }
}

/// Compressed rows of the graph of nodes that share a cell.
struct NodeGraph {
  std::vector<PetscInt> offsets{0};
  std::vector<PetscInt> neighbours;
};

NodeGraph node_graph(LocalIndex nodes, std::span<const LocalCells> cells) {
  const auto count = static_cast<std::size_t>(nodes);
  // Cells around each node, as compressed rows of spans.
  std::vector<std::size_t> first_cell(count + 1);
  for_each_cell(cells, [&](std::span<const LocalIndex> cell) {
    for (const auto node : cell)
      if (node < nodes) ++first_cell[static_cast<std::size_t>(node) + 1];
  });
  std::partial_sum(first_cell.begin(), first_cell.end(), first_cell.begin());
  std::vector<std::span<const LocalIndex>> around(first_cell[count]);
  auto next = first_cell;
  for_each_cell(cells, [&](std::span<const LocalIndex> cell) {
    for (const auto node : cell)
      if (node < nodes) around[next[static_cast<std::size_t>(node)]++] = cell;
  });

  NodeGraph graph;
  std::vector<LocalIndex> last_seen_by(count, -1);
  for (LocalIndex node = 0; node < nodes; ++node) {
    const auto row = static_cast<std::size_t>(node);
    last_seen_by[row] = node;
    for (std::size_t c = first_cell[row]; c < first_cell[row + 1]; ++c)
      for (const auto other : around[c])
        if (other < nodes && std::exchange(last_seen_by[static_cast<std::size_t>(other)], node) != node)
          graph.neighbours.push_back(other);
    std::sort(graph.neighbours.begin() + graph.offsets.back(), graph.neighbours.end());
    graph.offsets.push_back(static_cast<PetscInt>(graph.neighbours.size()));
  }
  return graph;
}

}  // namespace

std::vector<LocalIndex> locality_order(LocalIndex nodes, std::span<const LocalCells> cells) {
  if (nodes == 0) return {};
  NodeGraph graph = node_graph(nodes, cells);
  std::vector<PetscScalar> values(graph.neighbours.size());
  MatHandle adjacency;
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, nodes, nodes, graph.offsets.data(),
                                  graph.neighbours.data(), values.data(), adjacency.out()));
  IsHandle rows;
  IsHandle columns;
  check(MatGetOrdering(adjacency.get(), MATORDERINGRCM, rows.out(), columns.out()));
  const PetscInt* order = nullptr;
  check(ISGetIndices(rows.get(), &order));
  std::vector<LocalIndex> result(static_cast<std::size_t>(nodes));
  std::transform(order, order + nodes, result.begin(),
                 [](PetscInt old) { return static_cast<LocalIndex>(old); });
  check(ISRestoreIndices(rows.get(), &order));
  return result;
}

void sort_cells(LocalCells& cells, LocalIndex owned_nodes) {
  struct Key {
    bool touches_ghost;
    LocalIndex lowest_node;
    GlobalIndex global_id;
    std::size_t old;
  };
  const auto stride = static_cast<std::size_t>(node_count(cells.type));
  std::vector<Key> keys;
  keys.reserve(cells.global_ids.size());
  for (std::size_t cell = 0; cell < cells.global_ids.size(); ++cell) {
    const auto nodes = std::span(cells.nodes).subspan(cell * stride, stride);
    const auto [lowest, highest] = std::minmax_element(nodes.begin(), nodes.end());
    keys.push_back({*highest >= owned_nodes, *lowest, cells.global_ids[cell], cell});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.touches_ghost, a.lowest_node, a.global_id) <
           std::tie(b.touches_ghost, b.lowest_node, b.global_id);
  });

  LocalCells sorted{.type = cells.type, .region = cells.region, .nodes = {}, .global_ids = {}};
  sorted.nodes.reserve(cells.nodes.size());
  sorted.global_ids.reserve(cells.global_ids.size());
  for (const auto& key : keys) {
    const auto nodes = std::span(cells.nodes).subspan(key.old * stride, stride);
    sorted.nodes.insert(sorted.nodes.end(), nodes.begin(), nodes.end());
    sorted.global_ids.push_back(key.global_id);
    if (!cells.vectors.empty()) sorted.vectors.push_back(cells.vectors[key.old]);
    if (!key.touches_ghost) ++sorted.interior;
  }
  cells = std::move(sorted);
}

}  // namespace evert
