#pragma once
#include "evert/mesh/mesh.hpp"

#include <array>
#include <span>
#include <vector>

namespace evert {

/// A face of a cell that no other cell shares, seen counter-clockwise from outside.
struct BoundaryFace {
  std::array<GlobalIndex, 6> nodes{};  ///< 3 or 4 corners, then the 3 mid-edge nodes of tet10
  int corners = 0;                     ///< 3 or 4
  int node_count = 0;                  ///< 3, 4 or 6
  GlobalIndex cell = 0;                ///< number of its cell in the mesh, all blocks in order

  [[nodiscard]] std::span<const GlobalIndex> used() const {
    return std::span(nodes).first(static_cast<std::size_t>(node_count));
  }
};

/// The faces that belong to exactly one cell, in the order of the cells.
[[nodiscard]] std::vector<BoundaryFace> boundary_faces(const Mesh& mesh);

/// The nodes of the boundary faces, sorted.
[[nodiscard]] std::vector<GlobalIndex> boundary_nodes(const Mesh& mesh);

}  // namespace evert
