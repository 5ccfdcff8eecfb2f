#include "mesh_builder.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <utility>

namespace evert {

GlobalIndex MeshBuilder::add_node(const Vec3d& position) {
  mesh_.nodes.push_back(position);
  return mesh_.node_count() - 1;
}

std::int32_t MeshBuilder::region(const std::string& name) {
  const auto [entry, is_new] =
      region_numbers_.try_emplace(name, static_cast<std::int32_t>(mesh_.regions.size()));
  if (is_new) mesh_.regions.push_back(name);
  return entry->second;
}

CellPlace MeshBuilder::add_cell(CellType type, std::span<const GlobalIndex> nodes, std::int32_t region) {
  auto& block = blocks_[static_cast<std::size_t>(type)];
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
  block.region.push_back(region);
  return {type, block.region.size() - 1};
}

void MeshBuilder::set_vector(const CellPlace& cell, const Vec3d& vector) {
  auto& vectors = blocks_[static_cast<std::size_t>(cell.type)].vectors;
  if (vectors.size() <= cell.index) vectors.resize(cell.index + 1, Vec3d{});
  vectors[cell.index] = vector;
  has_vectors_ = true;
}

void MeshBuilder::add_to_node_set(const std::string& name, std::span<const GlobalIndex> nodes) {
  const auto [entry, is_new] = node_set_numbers_.try_emplace(name, mesh_.node_sets.size());
  if (is_new) mesh_.node_sets.push_back({name, {}});
  auto& set = mesh_.node_sets[entry->second].nodes;
  set.insert(set.end(), nodes.begin(), nodes.end());
}

Mesh MeshBuilder::finish(const std::string& file) && {
  for (const auto type : all_cell_types) {
    auto& block = blocks_[static_cast<std::size_t>(type)];
    block.type = type;
    if (has_vectors_) block.vectors.resize(block.region.size(), Vec3d{});
    if (block.size() > 0) mesh_.cells.push_back(std::move(block));
  }
  if (mesh_.cells.empty()) {
    std::string found = std::to_string(mesh_.node_count()) + " nodes";
    for (const auto& [kind, count] : lower_cells_) found += ", " + std::to_string(count) + " " + kind;
    throw UserError(file + ": has no volume cells (tet4, hex8, wedge6 or tet10), only " + found);
  }
  for (auto& set : mesh_.node_sets) {
    std::ranges::sort(set.nodes);
    set.nodes.erase(std::ranges::unique(set.nodes).begin(), set.nodes.end());
  }
  return std::move(mesh_);
}

}  // namespace evert
