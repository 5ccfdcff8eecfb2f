#include "evert/mesh/repair.hpp"

#include "evert/core/error.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include "components.hpp"
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace evert {
namespace {

/// Cells with something wrong: how many, and the first few.
struct Offenders {
  GlobalIndex count = 0;
  std::vector<GlobalIndex> first;

  void add(GlobalIndex cell) {
    constexpr std::size_t shown = 5;
    if (first.size() < shown) first.push_back(cell);
    ++count;
  }
  /// "3 of 10 cells are flat (cells 0, 4, 5)"
  [[nodiscard]] std::string text(GlobalIndex cells, const std::string& fault) const {
    std::string numbers;
    for (const auto cell : first) numbers += (numbers.empty() ? "" : ", ") + std::to_string(cell);
    if (count > static_cast<GlobalIndex>(first.size())) numbers += ", ...";
    return std::to_string(count) + " of " + std::to_string(cells) + " cells " + fault +
           " (counted from 0: " + numbers + ")";
  }
};

/// Mirrors a cell by renumbering its nodes.
void mirror(CellType type, std::span<GlobalIndex> nodes) {
  switch (type) {
    case CellType::tet4:
      std::swap(nodes[2], nodes[3]);
      break;
    case CellType::hex8:
      std::swap_ranges(nodes.begin(), nodes.begin() + 4, nodes.begin() + 4);
      break;
    case CellType::wedge6:
      std::swap_ranges(nodes.begin(), nodes.begin() + 3, nodes.begin() + 3);
      break;
    case CellType::tet10:
      std::swap(nodes[2], nodes[3]);
      std::swap(nodes[6], nodes[7]);  // edges 0-2 and 0-3
      std::swap(nodes[5], nodes[8]);  // edges 1-2 and 1-3
      break;
  }
}

/// A circular arc of 120 degrees has its middle at 0.29 of its chord; a middle node that stands for another
/// edge is at 0.5 or so.
constexpr double largest_middle_offset = 0.3;

}  // namespace

void require_positive_volumes(const Mesh& mesh, const std::string& what) {
  Offenders negative;
  Offenders broken;
  Offenders misplaced;
  for_each_cell(mesh,
                [&](GlobalIndex cell, const CellBlock& block, std::size_t, std::span<const Vec3d> nodes) {
                  if (middle_offset(block.type, nodes) > largest_middle_offset) return misplaced.add(cell);
                  const auto determinants = jacobian_range(block.type, nodes);
                  if (determinants.smallest > flat_jacobian) return;
                  const bool mirrored = determinants.largest < -flat_jacobian;
                  (mirrored ? negative : broken).add(cell);
                });
  if (misplaced.count > 0)
    throw UserError(
        what + ": " + misplaced.text(mesh.cell_count(), "have misplaced middle nodes") +
        "; each must be within 0.3 of the length of its edge from the middle of that edge: are they in "
        "the order of the format (edges 01 12 20 03 13 23 in VTK, 23 before 13 in Gmsh)?");
  if (broken.count > 0)
    throw UserError(what + ": " + broken.text(mesh.cell_count(), "are flat or folded") +
                    "; all must have positive volume at each quadrature point, so mesh that part again");
  if (negative.count > 0)
    throw UserError(
        what + ": " + negative.text(mesh.cell_count(), "have negative volume") +
        ", their nodes are in mirrored order; run 'evert mesh convert in out -reorient' to mend it");
}

GlobalIndex reorient(Mesh& mesh) {
  std::vector<std::pair<CellType, std::size_t>> negative;
  for_each_cell(mesh, [&](GlobalIndex, const CellBlock& block, std::size_t i, std::span<const Vec3d> nodes) {
    if (cell_volume(block.type, nodes) < 0) negative.emplace_back(block.type, i);
  });
  for (const auto& [type, i] : negative) {
    const auto stride = static_cast<std::size_t>(node_count(type));
    auto& block = *std::ranges::find(mesh.cells, type, &CellBlock::type);
    mirror(type, std::span(block.nodes).subspan(stride * i, stride));
  }
  return static_cast<GlobalIndex>(negative.size());
}

GlobalIndex drop_unused_nodes(Mesh& mesh) {
  std::vector<GlobalIndex> new_number(mesh.nodes.size(), -1);
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) new_number[static_cast<std::size_t>(node)] = 0;
  GlobalIndex kept = 0;
  for (std::size_t node = 0; node < new_number.size(); ++node) {
    if (new_number[node] < 0) continue;
    mesh.nodes[static_cast<std::size_t>(kept)] = mesh.nodes[node];
    new_number[node] = kept++;
  }
  const auto dropped = mesh.node_count() - kept;
  if (dropped == 0) return 0;
  mesh.nodes.resize(static_cast<std::size_t>(kept));
  const auto renumber = [&](GlobalIndex node) { return new_number[static_cast<std::size_t>(node)]; };
  for (auto& block : mesh.cells) std::ranges::transform(block.nodes, block.nodes.begin(), renumber);
  for (auto& set : mesh.node_sets) {
    std::ranges::transform(set.nodes, set.nodes.begin(), renumber);
    std::erase(set.nodes, -1);
  }
  return dropped;
}

GlobalIndex keep_largest_component(Mesh& mesh) {
  const auto component = components_of_nodes(mesh);
  const auto component_of = [&](const CellBlock& block, std::size_t cell) {
    const auto first = block.nodes[cell * static_cast<std::size_t>(node_count(block.type))];
    return static_cast<std::size_t>(component[static_cast<std::size_t>(first)]);
  };
  std::vector<GlobalIndex> cells(mesh.nodes.size(), 0);
  for (const auto& block : mesh.cells)
    for (std::size_t cell = 0; cell < block.region.size(); ++cell) ++cells[component_of(block, cell)];
  const auto largest = static_cast<std::size_t>(std::ranges::max_element(cells) - cells.begin());
  GlobalIndex dropped = 0;
  for (auto& block : mesh.cells) {
    const auto n = static_cast<std::size_t>(node_count(block.type));
    CellBlock kept{block.type, {}, {}};
    for (std::size_t cell = 0; cell < block.region.size(); ++cell) {
      if (component_of(block, cell) != largest) {
        ++dropped;
        continue;
      }
      kept.region.push_back(block.region[cell]);
      if (!block.vectors.empty()) kept.vectors.push_back(block.vectors[cell]);
      kept.nodes.insert(kept.nodes.end(), &block.nodes[cell * n], &block.nodes[cell * n] + n);
    }
    block = std::move(kept);
  }
  std::erase_if(mesh.cells, [](const CellBlock& block) { return block.region.empty(); });
  drop_unused_nodes(mesh);
  return dropped;
}

}  // namespace evert
