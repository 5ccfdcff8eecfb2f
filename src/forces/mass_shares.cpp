#include "mass_shares.hpp"

#include <algorithm>
#include <vector>

namespace evert {
namespace {

// The first round splits in proportion to stiffness; more than three gain a few per cent at most.
constexpr int rounds = 3;

/// One weight per node of every cell, by block.
using Weights = std::vector<std::vector<double>>;

/// Calls visit(weight, block, cell, local node) for every weight of this rank.
template <class Visit>
void for_each_weight(std::span<const std::unique_ptr<ElasticBlock>> blocks, Weights& weights, Visit&& visit) {
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b] == nullptr) continue;
    auto weight = weights[b].begin();
    for (LocalIndex cell = 0; cell < blocks[b]->cells(); ++cell)
      for (const LocalIndex node : blocks[b]->cell_nodes(cell)) visit(*weight++, *blocks[b], cell, node);
  }
}

/// Collective. Scales the weights at every node so that they sum to its mass over all ranks.
void normalize(const Halo& halo, std::span<const double> masses,
               std::span<const std::unique_ptr<ElasticBlock>> blocks, Weights& weights, NodeField& nodal) {
  const auto at = [&](LocalIndex node) -> double& {
    return nodal.local()[3 * static_cast<std::size_t>(node)];
  };
  std::fill(nodal.local().begin(), nodal.local().end(), 0.0);
  for_each_weight(blocks, weights, [&](double weight, const ElasticBlock&, LocalIndex, LocalIndex node) {
    at(node) += weight;
  });
  halo.begin_add(nodal);
  halo.end_add(nodal);
  for (std::size_t node = 0; node < masses.size(); ++node)
    at(static_cast<LocalIndex>(node)) = masses[node] / at(static_cast<LocalIndex>(node));
  halo.begin_update(nodal);
  halo.end_update(nodal);
  for_each_weight(blocks, weights, [&](double& weight, const ElasticBlock&, LocalIndex, LocalIndex node) {
    weight *= at(node);
  });
}

}  // namespace

void balance_masses(const DistributedMesh& mesh, const Halo& halo, std::span<const double> masses,
                    std::span<const std::unique_ptr<ElasticBlock>> blocks) {
  NodeField nodal(mesh);
  Weights weights(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (blocks[b] != nullptr)
      weights[b].assign(static_cast<std::size_t>(blocks[b]->cells()) * blocks[b]->cell_nodes(0).size(), 1.0);
  for (int round = 0; round <= rounds; ++round) {
    // Whose λ_e is larger than its neighbours' gets more of their mass. Soft cells of E = 0 have none.
    if (round > 0)
      for_each_weight(blocks, weights,
                      [](double& weight, const ElasticBlock& block, LocalIndex cell, LocalIndex) {
                        const double stiffness = block.rest_stiffness_of(cell);
                        weight *= stiffness > 0 ? stiffness : 1;
                      });
    normalize(halo, masses, blocks, weights, nodal);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (blocks[b] != nullptr) blocks[b]->set_mass_shares(weights[b]);
  }
}

}  // namespace evert
