#include "evert/mesh/boundary.hpp"

#include <algorithm>

namespace evert {
namespace {

struct FaceTemplate {
  std::array<int, 6> nodes;
  int corners;
  int node_count;
};

constexpr std::array tet4_faces{
    FaceTemplate{{0, 2, 1}, 3, 3},
    FaceTemplate{{0, 1, 3}, 3, 3},
    FaceTemplate{{1, 2, 3}, 3, 3},
    FaceTemplate{{0, 3, 2}, 3, 3},
};
constexpr std::array tet10_faces{
    FaceTemplate{{0, 2, 1, 6, 5, 4}, 3, 6},
    FaceTemplate{{0, 1, 3, 4, 8, 7}, 3, 6},
    FaceTemplate{{1, 2, 3, 5, 9, 8}, 3, 6},
    FaceTemplate{{0, 3, 2, 7, 9, 6}, 3, 6},
};
constexpr std::array hex8_faces{
    FaceTemplate{{0, 3, 2, 1}, 4, 4}, FaceTemplate{{4, 5, 6, 7}, 4, 4}, FaceTemplate{{0, 1, 5, 4}, 4, 4},
    FaceTemplate{{1, 2, 6, 5}, 4, 4}, FaceTemplate{{2, 3, 7, 6}, 4, 4}, FaceTemplate{{3, 0, 4, 7}, 4, 4},
};
constexpr std::array wedge6_faces{
    FaceTemplate{{0, 2, 1}, 3, 3},    FaceTemplate{{3, 4, 5}, 3, 3},    FaceTemplate{{0, 1, 4, 3}, 4, 4},
    FaceTemplate{{1, 2, 5, 4}, 4, 4}, FaceTemplate{{2, 0, 3, 5}, 4, 4},
};

std::span<const FaceTemplate> faces_of(CellType type) {
  switch (type) {
    case CellType::tet4:
      return tet4_faces;
    case CellType::hex8:
      return hex8_faces;
    case CellType::wedge6:
      return wedge6_faces;
    case CellType::tet10:
      return tet10_faces;
  }
  return {};
}

/// A face of a cell, by its sorted corners: the two cells of an inner face have equal ones.
struct FaceKey {
  std::array<GlobalIndex, 4> corners;
  std::int64_t number;  // of the face, counted over all cells

  friend auto operator<=>(const FaceKey&, const FaceKey&) = default;
};

BoundaryFace face_of(const FaceTemplate& face, std::span<const GlobalIndex> cell_nodes, GlobalIndex cell) {
  BoundaryFace result{.corners = face.corners, .node_count = face.node_count, .cell = cell};
  for (std::size_t i = 0; i < static_cast<std::size_t>(face.node_count); ++i)
    result.nodes[i] = cell_nodes[static_cast<std::size_t>(face.nodes[i])];
  return result;
}

/// Calls visit(face) for every face of every cell, always in the same order.
template <class Visit>
void for_each_face(const Mesh& mesh, Visit&& visit) {
  GlobalIndex cell = 0;
  for (const auto& block : mesh.cells) {
    const auto stride = static_cast<std::size_t>(node_count(block.type));
    const auto faces = faces_of(block.type);
    for (std::size_t first = 0; first < block.nodes.size(); first += stride, ++cell) {
      for (const auto& face : faces)
        visit(face_of(face, std::span(block.nodes).subspan(first, stride), cell));
    }
  }
}

}  // namespace

std::vector<BoundaryFace> boundary_faces(const Mesh& mesh) {
  std::vector<FaceKey> keys;
  keys.reserve(4 * static_cast<std::size_t>(mesh.cell_count()));
  for_each_face(mesh, [&](const BoundaryFace& face) {
    FaceKey key{{-1, -1, -1, -1}, static_cast<std::int64_t>(keys.size())};
    std::copy_n(face.nodes.begin(), face.corners, key.corners.begin());
    std::ranges::sort(key.corners);
    keys.push_back(key);
  });
  std::ranges::sort(keys);
  std::vector<bool> alone(keys.size(), true);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].corners != keys[i - 1].corners) continue;
    alone[static_cast<std::size_t>(keys[i].number)] = false;
    alone[static_cast<std::size_t>(keys[i - 1].number)] = false;
  }
  std::vector<BoundaryFace> boundary;
  std::size_t number = 0;
  for_each_face(mesh, [&](const BoundaryFace& face) {
    if (alone[number++]) boundary.push_back(face);
  });
  return boundary;
}

std::vector<GlobalIndex> boundary_nodes(const Mesh& mesh) {
  std::vector<GlobalIndex> nodes;
  for (const auto& face : boundary_faces(mesh)) {
    const auto used = face.used();
    nodes.insert(nodes.end(), used.begin(), used.end());
  }
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

}  // namespace evert
