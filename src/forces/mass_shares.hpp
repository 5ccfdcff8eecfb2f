#pragma once
#include "evert/forces/elastic_block.hpp"
#include "evert/mesh/distributed_mesh.hpp"

#include <memory>
#include <span>

namespace evert {

/// Collective. Splits the lumped mass of every node over the cells around it in proportion to what they need,
/// so that the bound on the stable step is nearly the true limit (docs/design/time-stepping.md). `masses` of
/// the owned nodes; `blocks` have every cell once, and may be null.
///
/// With the cells' own masses, ρV/4 a node, a flat cell of height h on a base of length L is believed to
/// vibrate at a rate of 1/h, while the nodes that it moves have the mass of their other cells too: 1/√(hL) is
/// true. Any split that sums to the masses gives a rigorous bound; the best has all λ_e of a neighbourhood
/// equal.
void balance_masses(const DistributedMesh& mesh, const Halo& halo, std::span<const double> masses,
                    std::span<const std::unique_ptr<ElasticBlock>> blocks);

}  // namespace evert
