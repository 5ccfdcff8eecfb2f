#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <memory>
#include <span>

namespace evert {

/// Collective. The smallest r ≥ 1 such that in every cell of every rank the largest eigenvalue of its
/// stiffness at rest against its own consistent masses is at most r times what its block takes for it
/// (ElasticBlock::rest_stiffness_of); infinity where there are cells of one point, of which blocks use more
/// than this number. `densities` per region; `blocks` parallel to `mesh.cells`, null where a rank has no
/// cells.
[[nodiscard]] double consistent_over_block_stiffness(const DistributedMesh& mesh,
                                                     std::span<const double> densities,
                                                     std::span<const std::unique_ptr<ElasticBlock>> blocks);

}  // namespace evert
