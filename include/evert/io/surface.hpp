#pragma once
#include "evert/mesh/mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace evert {

/// The outside of a mesh as triangles, for pictures.
struct Surface {
  /// A vertex and a cell that has it as a node.
  struct Touch {
    std::uint32_t vertex;
    GlobalIndex cell;
    friend auto operator<=>(const Touch&, const Touch&) = default;
  };

  std::vector<GlobalIndex> nodes;                       ///< per vertex: its mesh node
  std::vector<std::int32_t> regions;                    ///< per vertex: the region of a cell at it
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of vertices, counter-clockwise from outside
  std::vector<Touch> touches;                           ///< sorted, without repetition
};

/// The smallest and the largest coordinates.
[[nodiscard]] std::pair<Vec3d, Vec3d> bounds_of(std::span<const Vec3d> positions);

/// The boundary faces of all cells; a quadrilateral gives 2 triangles, a face of tet10 gives 4.
[[nodiscard]] Surface surface_of(const Mesh& mesh);

/// At most `max_triangles` of a surface: the vertices in each box of a grid become the one nearest to their
/// mean, never across regions. A surface that is small enough is left alone. `positions` per mesh node,
/// finite [m]. Vertex clustering: Rossignac, Borrel, Multi-resolution 3D approximations for rendering complex
/// scenes, 1993.
[[nodiscard]] Surface simplified(const Surface& surface, std::span<const Vec3d> positions,
                                 std::size_t max_triangles);

/// Per vertex the smallest value of the cells that touch it.
[[nodiscard]] std::vector<double> smallest_at_vertices(const Surface& surface,
                                                       std::span<const double> per_cell);

}  // namespace evert
