#pragma once
#include "evert/mesh/mesh.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace evert {

/// Volume [m³] of a cell with these corner (and mid-edge) positions, by the quadrature of its element
/// (PHYSICS 1); negative when the cell is turned inside out.
[[nodiscard]] double cell_volume(CellType type, std::span<const Vec3d> nodes);

/// Range of the determinants of ∂x/∂ξ at the quadrature points, divided by the cube of the longest edge: 0
/// for a flat cell, negative where it is turned inside out. Free of units.
struct JacobianRange {
  double smallest = 0;
  double largest = 0;
};
[[nodiscard]] JacobianRange jacobian_range(CellType type, std::span<const Vec3d> nodes);

/// A determinant of at most this cannot be told from 0 in double precision.
inline constexpr double flat_jacobian = 1e-14;

/// Distances of the corners that an edge joins [m].
struct EdgeRange {
  double shortest = 0;
  double longest = 0;
};
[[nodiscard]] EdgeRange edge_range(CellType type, std::span<const Vec3d> nodes);

/// The edges of a tetrahedron in VTK's order of the middle nodes of tet10.
inline constexpr std::array<std::array<std::size_t, 2>, 6> edges_of_tet{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// The largest distance of a middle node from the middle between its two corners, over the distance of these
/// two; 0 for cells without middle nodes.
[[nodiscard]] double middle_offset(CellType type, std::span<const Vec3d> nodes);

/// Angles [degrees] between the two faces that meet at an edge, for every edge at both of its ends: 12 for
/// tetrahedra (each twice), 24 for hexahedra, 18 for wedges. Appended to `angles`.
void append_dihedral_angles(CellType type, std::span<const Vec3d> nodes, std::vector<double>& angles);

/// Calls visit(cell number counted over all blocks, block, number in the block, positions of the nodes) for
/// each cell.
template <class Visit>
void for_each_cell(const Mesh& mesh, Visit&& visit) {
  std::vector<Vec3d> positions;
  GlobalIndex cell = 0;
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    for (std::size_t i = 0; i < block.region.size(); ++i, ++cell) {
      positions.clear();
      for (const auto node : std::span(block.nodes).subspan(stride * i, stride))
        positions.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
      visit(cell, block, i, std::span<const Vec3d>(positions));
    }
  }
}

}  // namespace evert
