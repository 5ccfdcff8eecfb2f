#include "evert/mesh/quality.hpp"

#include "evert/mesh/boundary.hpp"

#include "components.hpp"
#include "duplicate_nodes.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace evert {
namespace {

/// Collects a Spread.
class Spreading {
 public:
  void add(double value) {
    spread_.smallest = std::min(spread_.smallest, value);
    spread_.largest = std::max(spread_.largest, value);
    sum_ += value;
    ++count_;
  }
  [[nodiscard]] Spread result() const {
    if (count_ == 0) return {};
    auto result = spread_;
    result.mean = sum_ / static_cast<double>(count_);
    return result;
  }

 private:
  Spread spread_{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), 0};
  double sum_ = 0;
  GlobalIndex count_ = 0;
};

double norm(const Vec3d& a) { return std::hypot(a[0], a[1], a[2]); }

double aspect_ratio(CellType type, std::span<const Vec3d> x, const EdgeRange& edges, double volume) {
  if (type == CellType::hex8 || type == CellType::wedge6) return edges.longest / edges.shortest;
  const double largest_face =
      0.5 * std::max({norm(cross(x[1] - x[0], x[2] - x[0])), norm(cross(x[1] - x[0], x[3] - x[0])),
                      norm(cross(x[2] - x[0], x[3] - x[0])), norm(cross(x[2] - x[1], x[3] - x[1]))});
  const double smallest_height = 3 * std::abs(volume) / largest_face;
  return std::sqrt(2.0 / 3) * edges.longest / smallest_height;
}

GlobalIndex count_components(const Mesh& mesh) {
  const auto component = components_of_nodes(mesh);
  std::vector<bool> used(mesh.nodes.size());
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) used[static_cast<std::size_t>(node)] = true;
  GlobalIndex components = 0;
  for (std::size_t node = 0; node < component.size(); ++node)
    components += used[node] && component[node] == static_cast<GlobalIndex>(node) ? 1 : 0;
  return components;
}

void measure_nodes(const Mesh& mesh, MeshQuality& quality) {
  if (mesh.nodes.empty()) return;
  quality.lower = quality.upper = mesh.nodes.front();
  for (const auto& node : mesh.nodes)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      quality.lower[axis] = std::min(quality.lower[axis], node[axis]);
      quality.upper[axis] = std::max(quality.upper[axis], node[axis]);
    }
  std::vector<bool> used(mesh.nodes.size());
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) used[static_cast<std::size_t>(node)] = true;
  quality.unused_nodes = std::ranges::count(used, false);
  quality.duplicate_nodes = count_duplicate_nodes(mesh.nodes, 1e-10 * norm(quality.upper - quality.lower));
}

void note_faults(const JacobianRange& determinants, GlobalIndex cell, MeshQuality& quality) {
  constexpr std::size_t shown = 10;
  if (determinants.smallest > flat_jacobian) return;
  ++(determinants.largest < -flat_jacobian ? quality.negative_cells : quality.flat_cells);
  if (quality.first_faulty.size() < shown) quality.first_faulty.push_back(cell);
}

void measure_cells(const Mesh& mesh, MeshQuality& quality) {
  Spreading volumes;
  Spreading angles;
  Spreading aspects;
  quality.edges = {std::numeric_limits<double>::max(), 0};
  std::vector<double> angles_of_cell;
  for_each_cell(mesh, [&](GlobalIndex cell, const CellBlock& block, std::size_t i, std::span<const Vec3d> x) {
    const double volume = cell_volume(block.type, x);
    const auto edges = edge_range(block.type, x);
    volumes.add(volume);
    aspects.add(aspect_ratio(block.type, x, edges, volume));
    quality.total_volume += volume;
    quality.edges.shortest = std::min(quality.edges.shortest, edges.shortest);
    quality.edges.longest = std::max(quality.edges.longest, edges.longest);
    auto& region = quality.regions[static_cast<std::size_t>(block.region[i])];
    region.volume += volume;
    ++region.size;
    ++quality.cells_of_type[static_cast<std::size_t>(block.type)];
    note_faults(jacobian_range(block.type, x), cell, quality);
    angles_of_cell.clear();
    append_dihedral_angles(block.type, x, angles_of_cell);
    for (const double angle : angles_of_cell) {
      angles.add(angle);
      const auto bin = static_cast<std::size_t>(angle / 180 * MeshQuality::angle_bins);
      ++quality.angle_histogram[std::min(bin, quality.angle_histogram.size() - 1)];
    }
  });
  if (mesh.cell_count() == 0) quality.edges = {};
  quality.volume = volumes.result();
  quality.dihedral_angle = angles.result();
  quality.aspect_ratio = aspects.result();
}

}  // namespace

MeshQuality measure_quality(const Mesh& mesh) {
  MeshQuality quality;
  quality.nodes = mesh.node_count();
  quality.cells = mesh.cell_count();
  for (const auto& name : mesh.regions) quality.regions.push_back({name, 0, 0});
  for (const auto& set : mesh.node_sets)
    quality.node_sets.push_back({set.name, static_cast<GlobalIndex>(set.nodes.size()), 0});
  quality.boundary_faces = static_cast<GlobalIndex>(boundary_faces(mesh).size());
  quality.components = count_components(mesh);
  measure_nodes(mesh, quality);
  measure_cells(mesh, quality);
  return quality;
}

}  // namespace evert
