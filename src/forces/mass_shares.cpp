#include "mass_shares.hpp"

#include "evert/elements/reference_element.hpp"
#include "evert/elements/rest_shape.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace evert {
namespace {

// The first round splits in proportion to stiffness; more than three gain a few per cent at most.
constexpr int rounds = 3;

/// One weight per node of every cell, by block.
using Weights = std::vector<std::vector<double>>;

/// What each node of each cell needs at first: the root of Σ_q V |g_a|² over its shape gradient g_a, against
/// the largest of the cell. The largest eigenvalue of a flat cell goes with Σ_a |g_a|²/m_a, which is least,
/// the sum of the masses given, where m_a goes with |g_a|.
std::vector<double> gradient_weights(const ElasticBlock& block, std::span<const Vec3d> rest_positions) {
  constexpr double least = 0.01;  // every node moves with some of the cell
  constexpr double alike = 0.5;   // well-shaped cells do as well with equal shares
  std::vector<double> weights(static_cast<std::size_t>(block.cells()) *
                              static_cast<std::size_t>(node_count(block.type())));
  with_reference_element(block.type(), [&](const auto& element) {
    const auto nodes = static_cast<std::size_t>(element.nodes);
    for (LocalIndex c = 0; c < block.cells(); ++c) {
      const auto numbers = block.cell_nodes(c);
      const std::span<const LocalIndex> cell(numbers.begin(), nodes);
      const auto of_cell = std::span(weights).subspan(nodes * static_cast<std::size_t>(c), nodes);
      for (std::size_t q = 0; q < static_cast<std::size_t>(element.points); ++q) {
        const Mat3d jacobian = rest_jacobian(element, q, cell, rest_positions);
        const Mat3d to_reference = inverse(jacobian);
        for (std::size_t a = 0; a < nodes; ++a) {
          const Vec3d gradient = transpose_times(to_reference, element.gradients[q][a]);
          of_cell[a] += point_volume(element, q, jacobian) * dot(gradient, gradient);
        }
      }
      const auto [smallest, largest] = std::ranges::minmax(of_cell);
      if (smallest > alike * alike * largest) {
        std::ranges::fill(of_cell, 1.0);
      } else {
        for (double& weight : of_cell) weight = std::max(std::sqrt(weight / largest), least);
      }
    }
  });
  return weights;
}

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
    if (blocks[b] != nullptr) weights[b] = gradient_weights(*blocks[b], mesh.rest_positions);
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
