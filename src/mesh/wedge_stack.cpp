#include "evert/core/error.hpp"
#include "evert/core/positive.hpp"
#include "evert/mesh/bad_meshes.hpp"
#include "evert/mesh/boundary.hpp"

#include "mesh_size.hpp"
#include <array>
#include <cmath>

namespace evert {
namespace {

/// The three wedges of the prism over the triangle a, a + 1, a + 2, below the triangle of the next three
/// nodes. All layers are cut alike, so that neighbours share the diagonals.
void add_wedges(std::vector<GlobalIndex>& nodes, GlobalIndex a) {
  const GlobalIndex b = a + 3;
  nodes.insert(nodes.end(), {a, a + 1, a + 2, b + 2});
  nodes.insert(nodes.end(), {a + 1, a, b + 1, b + 2});
  nodes.insert(nodes.end(), {a, b, b + 1, b + 2});
}

}  // namespace

Mesh generate_wedge_stack(const WedgeStack& stack) {
  require_positive(stack.edge_length, "edge_length");
  if (!(stack.edge_ratio > 0) || !std::isfinite(stack.edge_ratio))
    throw UserError(formatted("edge_ratio is %g, but must be positive and finite", stack.edge_ratio));
  if (stack.layers < 1) throw UserError(formatted("layers are %d, but must be at least 1", stack.layers));
  require_possible_size(3.0 * stack.layers, 3.0 * stack.layers);

  const double edge = stack.edge_length, height = edge / stack.edge_ratio;
  const double from_middle = edge / std::sqrt(12.0);  // of a triangle to its sides
  const double top = 0.5 * stack.layers * height, tip = top + edge * std::sqrt(2.0 / 3.0);
  Mesh mesh;
  for (int level = 0; level <= stack.layers; ++level) {
    const double z = (level - 0.5 * stack.layers) * height;
    mesh.nodes.insert(mesh.nodes.end(), {Vec3d{-0.5 * edge, -from_middle, z},
                                         Vec3d{0.5 * edge, -from_middle, z}, Vec3d{0, 2 * from_middle, z}});
  }
  const auto above = mesh.node_count(), below = above + 1;
  mesh.nodes.insert(mesh.nodes.end(), {Vec3d{0, 0, tip}, Vec3d{0, 0, -tip}});

  CellBlock block;
  for (GlobalIndex first = 0; first + 3 < above; first += 3) add_wedges(block.nodes, first);
  block.nodes.insert(block.nodes.end(), {above - 3, above - 2, above - 1, above});
  block.nodes.insert(block.nodes.end(), {1, 0, 2, below});
  block.region.assign(block.nodes.size() / 4, 0);
  mesh.cells.push_back(std::move(block));
  mesh.regions = {"body"};
  mesh.node_sets = {{"surface", boundary_nodes(mesh)}, {"z_min", {below}}, {"z_max", {above}}};
  return mesh;
}

}  // namespace evert
