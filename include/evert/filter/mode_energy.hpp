#pragma once
#include "evert/filter/spectrum.hpp"

#include <vector>

namespace evert {

/// Collective. What share of the elastic energy of a vibration each cell of this rank holds: u_eᵀ K_e u_e /
/// ω², per entry of DistributedMesh::cells, per cell; all sum to 1 over the ranks. K_e at `x`, whose ghosts
/// must be up to date, as it was when `mode` was found; `mode` not of frequency 0.
[[nodiscard]] std::vector<std::vector<double>> energy_shares(const DistributedMesh& mesh,
                                                             const ElasticForces& elastic, const NodeField& x,
                                                             const FastestMode& mode);

}  // namespace evert
