#include "evert/elements/batching.hpp"

#include <algorithm>

namespace evert {
namespace {

/// Cells that wait for a batch: long enough to find `lanes` strangers among neighbours, short enough to stay
/// in cache. Longer windows do not fill more batches.
constexpr std::size_t window = 160;

using CellNodes = std::span<const LocalIndex>;

bool share_a_node(CellNodes a, CellNodes b) {
  return std::any_of(a.begin(), a.end(),
                     [&](LocalIndex node) { return std::find(b.begin(), b.end(), node) != b.end(); });
}

std::vector<LocalIndex> by_smallest_node(std::span<const LocalIndex> cells, const auto& nodes_of) {
  std::vector<LocalIndex> sorted(cells.begin(), cells.end());
  const auto smallest = [&](LocalIndex cell) { return std::ranges::min(nodes_of(cell)); };
  std::ranges::stable_sort(sorted, {}, smallest);
  return sorted;
}

}  // namespace

std::vector<LocalIndex> batch_order(std::span<const LocalIndex> cells, std::span<const LocalIndex> nodes,
                                    int nodes_per_cell, int lanes) {
  const auto per_cell = static_cast<std::size_t>(nodes_per_cell);
  const auto nodes_of = [&](LocalIndex cell) {
    return nodes.subspan(static_cast<std::size_t>(cell) * per_cell, per_cell);
  };
  const std::vector<LocalIndex> sorted = by_smallest_node(cells, nodes_of);

  std::vector<LocalIndex> order;
  order.reserve(sorted.size());
  std::vector<LocalIndex> waiting;
  std::vector<LocalIndex> batch;
  std::size_t next = 0;
  while (order.size() < sorted.size()) {
    while (waiting.size() < window && next < sorted.size()) waiting.push_back(sorted[next++]);
    batch.clear();
    const auto full = [&] { return batch.size() == static_cast<std::size_t>(lanes); };
    const auto join = [&](LocalIndex cell) {
      batch.push_back(cell);
      return true;
    };
    const auto stranger = [&](LocalIndex cell) {
      return std::ranges::none_of(
          batch, [&](LocalIndex other) { return share_a_node(nodes_of(cell), nodes_of(other)); });
    };
    std::erase_if(waiting, [&](LocalIndex cell) { return !full() && stranger(cell) && join(cell); });
    // No stranger left in the window: a batch that shares a node is slower, not wrong.
    std::erase_if(waiting, [&](LocalIndex cell) { return !full() && join(cell); });
    order.insert(order.end(), batch.begin(), batch.end());
  }
  return order;
}

}  // namespace evert
