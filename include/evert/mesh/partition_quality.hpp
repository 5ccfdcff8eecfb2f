#pragma once
#include "evert/mesh/mesh.hpp"

#include <span>
#include <vector>

namespace evert {

/// What a partition costs one rank.
struct RankLoad {
  GlobalIndex cells = 0;
  GlobalIndex work = 0;         ///< quadrature points of its cells
  GlobalIndex nodes = 0;        ///< that its cells touch
  GlobalIndex cut_faces = 0;    ///< of its cells, shared with cells of other ranks
  std::vector<int> neighbours;  ///< the ranks behind these faces, sorted
};

struct PartitionQuality {
  std::vector<RankLoad> ranks;
  GlobalIndex edge_cut = 0;  ///< faces between cells of different ranks
  double imbalance = 1;      ///< largest work of a rank over the mean
};

/// Not collective. `rank_of_cell`: for every cell, blocks in order, a rank from 0 to ranks − 1.
[[nodiscard]] PartitionQuality measure_partition(const Mesh& mesh, std::span<const int> rank_of_cell,
                                                 int ranks);

}  // namespace evert
