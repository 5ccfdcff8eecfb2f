#pragma once
#include "evert/mesh/distributed_mesh.hpp"

#include <span>
#include <vector>

/// Orders that keep neighbours close in memory.
namespace evert {

/// Reverse Cuthill-McKee order of the nodes [0, nodes) joined by the cells; higher node numbers in `cells`
/// are ignored. result[new number] = old number.
[[nodiscard]] std::vector<LocalIndex> locality_order(LocalIndex nodes, std::span<const LocalCells> cells);

/// Sorts the cells: those that touch only nodes [0, owned_nodes) first, then by lowest node, then as they
/// were in the whole mesh; counts the former in `interior`.
void sort_cells(LocalCells& cells, LocalIndex owned_nodes);

}  // namespace evert
