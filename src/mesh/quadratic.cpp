#include "evert/mesh/quadratic.hpp"

#include "evert/core/error.hpp"
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace evert {
namespace {

using Edge = std::pair<GlobalIndex, GlobalIndex>;

Edge edge_of(std::span<const GlobalIndex> tet, std::size_t number) {
  const auto [a, b] = edges_of_tet[number];
  return std::minmax(tet[a], tet[b]);
}

std::span<const GlobalIndex> corners(const CellBlock& tets, std::size_t cell) {
  return std::span(tets.nodes).subspan(4 * cell, 4);
}

/// Every edge once, sorted.
std::vector<Edge> all_edges(const CellBlock& tets) {
  std::vector<Edge> edges;
  edges.reserve(6 * tets.region.size());
  for (std::size_t cell = 0; cell < tets.region.size(); ++cell)
    for (std::size_t e = 0; e < 6; ++e) edges.push_back(edge_of(corners(tets, cell), e));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

bool contains(std::span<const GlobalIndex> sorted, GlobalIndex node) {
  return std::binary_search(sorted.begin(), sorted.end(), node);
}

/// The edges of the faces of the boundary, sorted.
std::vector<Edge> boundary_edges(const Mesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& face : boundary_faces(mesh))
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(face.nodes[k], face.nodes[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Every edge once, and which of them are on the boundary.
struct Edges {
  std::vector<Edge> all;
  std::vector<Edge> on_boundary;
  std::vector<GlobalIndex> boundary_nodes;
};

/// A set of nodes of the boundary gains middles of the boundary only: an edge through the body may join two
/// of them.
void add_middles(NodeSet& set, const Edges& edges, GlobalIndex first_middle) {
  const auto corners = set.nodes;
  const bool is_surface = std::all_of(corners.begin(), corners.end(),
                                      [&](GlobalIndex node) { return contains(edges.boundary_nodes, node); });
  for (std::size_t e = 0; e < edges.all.size(); ++e) {
    const auto& edge = edges.all[e];
    if (!contains(corners, edge.first) || !contains(corners, edge.second)) continue;
    if (is_surface && !std::binary_search(edges.on_boundary.begin(), edges.on_boundary.end(), edge)) continue;
    set.nodes.push_back(first_middle + static_cast<GlobalIndex>(e));
  }
}

}  // namespace

void make_quadratic(Mesh& mesh) {
  for (const auto& block : mesh.cells) {
    if (block.type != CellType::tet4)
      throw UserError("only tetrahedra can be made quadratic, but the mesh has cells of type " +
                      std::string(name_of(block.type)));
  }
  if (mesh.cells.empty()) return;
  CellBlock& block = mesh.cells.front();
  const Edges edges{all_edges(block), boundary_edges(mesh), boundary_nodes(mesh)};
  const auto first_middle = mesh.node_count();
  for (const auto& [a, b] : edges.all)
    mesh.nodes.push_back(0.5 *
                         (mesh.nodes[static_cast<std::size_t>(a)] + mesh.nodes[static_cast<std::size_t>(b)]));
  for (auto& set : mesh.node_sets) add_middles(set, edges, first_middle);
  CellBlock quadratic{CellType::tet10, {}, block.region, block.vectors};
  quadratic.nodes.reserve(10 * block.region.size());
  for (std::size_t cell = 0; cell < block.region.size(); ++cell) {
    const auto tet = corners(block, cell);
    quadratic.nodes.insert(quadratic.nodes.end(), tet.begin(), tet.end());
    for (std::size_t e = 0; e < 6; ++e) {
      const auto found = std::lower_bound(edges.all.begin(), edges.all.end(), edge_of(tet, e));
      quadratic.nodes.push_back(first_middle + (found - edges.all.begin()));
    }
  }
  block = std::move(quadratic);
}

}  // namespace evert
