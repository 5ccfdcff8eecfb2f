#pragma once
#include "evert/core/index.hpp"

#include <span>
#include <vector>

/// The order in which cells are put into SIMD batches.
namespace evert {

/// An order of `cells` (numbers into `nodes`, `nodes_per_cell` each) such that, read in groups of `lanes`,
/// neighbours in the mesh stay close in time but the cells of one group share no node where that can be had:
/// the scatter of a group then never waits for a sum it has just stored itself. Starts from ascending
/// smallest node, so that nodes numbered for locality are met in that order, and picks greedily from a
/// sliding window. Deterministic.
[[nodiscard]] std::vector<LocalIndex> batch_order(std::span<const LocalIndex> cells,
                                                  std::span<const LocalIndex> nodes, int nodes_per_cell,
                                                  int lanes);

}  // namespace evert
