#include "scatter_inverted.hpp"

#include "evert/math/nodal.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace evert {
namespace {

// Sizes of a cell: farther apart than that, nodes take long to come together again.
constexpr double most_reach = 4;

/// Root of the mean square distance of the nodes of a cell from their mean at rest [m].
double cell_size(const DistributedMesh& mesh, std::span<const LocalIndex> nodes) {
  const double share = 1 / static_cast<double>(nodes.size());
  Vec3d mean{};
  for (const auto node : nodes) mean += share * mesh.rest_positions[static_cast<std::size_t>(node)];
  double squares = 0;
  for (const auto node : nodes) {
    const auto from_mean = mesh.rest_positions[static_cast<std::size_t>(node)] - mean;
    squares += share * dot(from_mean, from_mean);
  }
  return std::sqrt(squares);
}

/// Per owned node: the sum of the sizes of the chosen cells around it, and their number. chosen(block, cells)
/// fills a flag per cell.
template <class Chosen>
NodeField around_cells(const System& system, Chosen&& chosen) {
  const auto& mesh = system.mesh;
  NodeField around(mesh);
  auto sums = around.local();
  for (std::size_t block = 0; block < mesh.cells.size(); ++block) {
    const auto& cells = mesh.cells[block];
    const auto n = static_cast<std::size_t>(node_count(cells.type));
    const std::vector<bool> flags = chosen(block, cells);
    for (std::size_t cell = 0; cell < flags.size(); ++cell) {
      if (!flags[cell]) continue;
      const auto nodes = std::span(cells.nodes).subspan(n * cell, n);
      const double size = cell_size(mesh, nodes);
      for (const auto node : nodes) {
        sums[3 * static_cast<std::size_t>(node)] += size;
        sums[3 * static_cast<std::size_t>(node) + 1] += 1;
      }
    }
  }
  system.elastic.halo().begin_add(around);
  system.elastic.halo().end_add(around);
  return around;
}

NodeField around_inverted(const System& system, const NodeField& x) {
  return around_cells(system, [&](std::size_t block, const LocalCells& cells) {
    std::vector<double> stretch(static_cast<std::size_t>(cells.size()));
    system.elastic.min_stretch(x, block, stretch);
    std::vector<bool> inverted(stretch.size());
    for (std::size_t cell = 0; cell < stretch.size(); ++cell) inverted[cell] = stretch[cell] < 0;
    return inverted;
  });
}

/// The same for all cells that have a node in `before`.
NodeField one_ring_more(const System& system, NodeField before) {
  system.elastic.halo().begin_update(before);
  system.elastic.halo().end_update(before);
  return around_cells(system, [&](std::size_t /*block*/, const LocalCells& cells) {
    const auto n = static_cast<std::size_t>(node_count(cells.type));
    std::vector<bool> touched(static_cast<std::size_t>(cells.size()));
    for (std::size_t i = 0; i < cells.nodes.size(); ++i)
      if (before.local()[3 * static_cast<std::size_t>(cells.nodes[i]) + 1] > 0) touched[i / n] = true;
    return touched;
  });
}

/// Uniform in the cube of edge 2 around the origin; depends on the numbers only.
Vec3d random_direction(std::uint64_t attempt, GlobalIndex node) {
  const auto number = static_cast<std::uint64_t>(node);
  std::seed_seq mix{attempt, number & 0xffffffffU, number >> 32U};
  std::mt19937_64 random(mix);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vec3d direction{};
  for (auto& component : direction.components) component = uniform(random);
  return direction;
}

}  // namespace

bool scatter_inverted(const System& system, std::span<const NodeConstraint> held, std::uint64_t attempt,
                      int rings, NodeField& x) {
  const auto& halo = system.elastic.halo();
  halo.begin_update(x);
  halo.end_update(x);
  auto around = around_inverted(system, x);
  for (int ring = 0; ring < rings; ++ring) around = one_ring_more(system, std::move(around));
  const double reach = std::min(std::exp2(rings / 2), most_reach);
  NodeField change(system.mesh);
  int found = 0;
  for (LocalIndex node = 0; node < system.mesh.owned_nodes; ++node) {
    const auto [size, count, unused] = node_value(around.owned(), node).components;
    if (count == 0) continue;
    found = 1;
    set_node_value(change.owned(), node,
                   reach * size / count *
                       random_direction(attempt, system.mesh.natural_nodes[static_cast<std::size_t>(node)]));
  }
  MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, system.mesh.comm);
  project(held, change.owned());
  for (std::size_t i = 0; i < x.owned().size(); ++i) x.owned()[i] += change.owned()[i];
  x.touched();
  return found != 0;
}

}  // namespace evert
