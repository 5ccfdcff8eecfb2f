#include "evert/core/positive.hpp"
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/repair.hpp"

#include "mesh_size.hpp"
#include "number_text.hpp"
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace evert {
namespace {

using Corners = std::array<GlobalIndex, 8>;  ///< of a cube, in VTK's order

/// Node numbers of a grid of cubes: its corners and, behind them, the middles of the cubes.
class Grid {
 public:
  Grid(const Vec3d& size, const std::array<int, 3>& divisions, const std::array<int, 2>& hole)
      : size_(size), n_(divisions), hole_(hole) {}

  [[nodiscard]] int divisions(std::size_t axis) const { return n_[axis]; }
  /// False outside the box and in its hole.
  [[nodiscard]] bool has_cube(int i, int j, int k) const {
    const std::array cube{i, j, k};
    bool in_box = true, in_hole = true;
    for (std::size_t axis = 0; axis < 3; ++axis) in_box = in_box && cube[axis] >= 0 && cube[axis] < n_[axis];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int first = (n_[axis] - hole_[axis]) / 2;
      in_hole = in_hole && cube[axis] >= first && cube[axis] < first + hole_[axis];
    }
    return in_box && !in_hole;
  }
  [[nodiscard]] GlobalIndex corner(int i, int j, int k) const {
    return (GlobalIndex{k} * (n_[1] + 1) + j) * (n_[0] + 1) + i;
  }
  [[nodiscard]] GlobalIndex corner_count() const { return corner(0, 0, n_[2] + 1); }
  [[nodiscard]] GlobalIndex middle(int i, int j, int k) const {
    return corner_count() + (GlobalIndex{k} * n_[1] + j) * n_[0] + i;
  }
  [[nodiscard]] Corners corners(int i, int j, int k) const {
    return {
        corner(i, j, k),     corner(i + 1, j, k),     corner(i + 1, j + 1, k),     corner(i, j + 1, k),
        corner(i, j, k + 1), corner(i + 1, j, k + 1), corner(i + 1, j + 1, k + 1), corner(i, j + 1, k + 1)};
  }
  /// Of a corner, or of a middle with i + 0.5 and so on. Opposite nodes get exactly opposite coordinates.
  [[nodiscard]] Vec3d position(double i, double j, double k) const {
    return {coordinate(0, i), coordinate(1, j), coordinate(2, k)};
  }

 private:
  [[nodiscard]] double coordinate(std::size_t axis, double i) const {
    return size_[axis] * ((2 * i - n_[axis]) / (2.0 * n_[axis]));
  }

  Vec3d size_;
  std::array<int, 3> n_;
  std::array<int, 2> hole_;
};

template <class Visit>
void for_each_cube(const Grid& grid, Visit&& visit) {
  for (int k = 0; k < grid.divisions(2); ++k)
    for (int j = 0; j < grid.divisions(1); ++j)
      for (int i = 0; i < grid.divisions(0); ++i) visit(i, j, k);
}

/// Adds cells that use the corners `which` of a cube, node_count(type) for each cell.
void add_cells(CellBlock& block, const Corners& corners, std::span<const int> which) {
  for (const int corner : which) block.nodes.push_back(corners[static_cast<std::size_t>(corner)]);
}

constexpr std::array hex_pattern{0, 1, 2, 3, 4, 5, 6, 7};
constexpr std::array wedge_pattern{0, 1, 2, 4, 5, 6, 0, 2, 3, 4, 6, 7};
constexpr std::array five_even{0, 1, 2, 5, 0, 2, 3, 7, 0, 5, 7, 4, 2, 7, 5, 6, 0, 2, 7, 5};
constexpr std::array five_odd{1, 2, 3, 6, 0, 1, 3, 4, 1, 6, 4, 5, 3, 4, 6, 7, 1, 3, 4, 6};
constexpr std::array kuhn_pattern{0, 1, 2, 6, 0, 5, 1, 6, 0, 2, 3, 6, 0, 3, 7, 6, 0, 4, 5, 6, 0, 7, 4, 6};

void add_cube(CellBlock& block, BoxCells cells, const Corners& corners, bool odd) {
  switch (cells) {
    case BoxCells::hex8:
      return add_cells(block, corners, hex_pattern);
    case BoxCells::wedge6:
      return add_cells(block, corners, wedge_pattern);
    case BoxCells::tet5:
      return odd ? add_cells(block, corners, five_odd) : add_cells(block, corners, five_even);
    case BoxCells::tet6:
      return add_cells(block, corners, kuhn_pattern);
    case BoxCells::bcc:
      return;
  }
}

/// A face of a cube, counter-clockwise from outside, and the step to the cube behind it.
struct CubeFace {
  std::array<int, 4> corners;
  std::array<int, 3> step;
};
constexpr std::array cube_faces{
    CubeFace{{0, 3, 2, 1}, {0, 0, -1}}, CubeFace{{4, 5, 6, 7}, {0, 0, 1}},
    CubeFace{{0, 1, 5, 4}, {0, -1, 0}}, CubeFace{{2, 3, 7, 6}, {0, 1, 0}},
    CubeFace{{3, 0, 4, 7}, {-1, 0, 0}}, CubeFace{{1, 2, 6, 5}, {1, 0, 0}},
};

/// The tetrahedra of the lattice around the middle of one cube: four over each face shared with a cube of
/// higher number, two (half an octahedron) on the surface.
void add_bcc_cells(CellBlock& block, const Grid& grid, int i, int j, int k) {
  const auto corners = grid.corners(i, j, k);
  const auto middle = grid.middle(i, j, k);
  for (const auto& face : cube_faces) {
    std::array<GlobalIndex, 4> f{};
    for (std::size_t c = 0; c < 4; ++c) f[c] = corners[static_cast<std::size_t>(face.corners[c])];
    const std::array<int, 3> next{i + face.step[0], j + face.step[1], k + face.step[2]};
    if (!grid.has_cube(next[0], next[1], next[2])) {
      block.nodes.insert(block.nodes.end(), {f[0], f[2], f[1], middle, f[0], f[3], f[2], middle});
      continue;
    }
    const auto other = grid.middle(next[0], next[1], next[2]);
    if (other < middle) continue;
    for (std::size_t c = 0; c < 4; ++c)
      block.nodes.insert(block.nodes.end(), {f[(c + 1) % 4], f[c], other, middle});
  }
}

CellType cell_type(BoxCells cells) {
  if (cells == BoxCells::hex8) return CellType::hex8;
  return cells == BoxCells::wedge6 ? CellType::wedge6 : CellType::tet4;
}

void add_face_sets(Mesh& mesh, const Grid& grid) {
  const std::array<std::string, 3> axes{"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    NodeSet low{axes[axis] + "_min", {}};
    NodeSet high{axes[axis] + "_max", {}};
    for (int k = 0; k <= grid.divisions(2); ++k)
      for (int j = 0; j <= grid.divisions(1); ++j)
        for (int i = 0; i <= grid.divisions(0); ++i) {
          const int position = std::array{i, j, k}[axis];
          if (position == 0) low.nodes.push_back(grid.corner(i, j, k));
          if (position == grid.divisions(axis)) high.nodes.push_back(grid.corner(i, j, k));
        }
    mesh.node_sets.push_back(std::move(low));
    mesh.node_sets.push_back(std::move(high));
  }
}

void require_hole_in_the_middle(const std::array<int, 3>& divisions, const std::array<int, 2>& hole) {
  if (hole == std::array<int, 2>{}) return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto numbers = "hole is " + std::to_string(hole[axis]) + " of " + std::to_string(divisions[axis]) +
                         " cubes along " + std::string(1, "xy"[axis]);
    if (hole[axis] < 1 || hole[axis] >= divisions[axis])
      throw UserError(numbers + ", but must be at least 1 and less than all");
    if ((divisions[axis] - hole[axis]) % 2 != 0)
      throw UserError(numbers + ": to be in the middle, both must be odd or both even");
  }
}

double cells_per_cube(BoxCells cells) {
  switch (cells) {
    case BoxCells::hex8:
      return 1;
    case BoxCells::wedge6:
      return 2;
    case BoxCells::tet5:
      return 5;
    case BoxCells::tet6:
      return 6;
    case BoxCells::bcc:
      return 12;
  }
  return 0;
}

}  // namespace

Mesh generate_box(const Vec3d& size, double edge_length, BoxCells cells) {
  for (const double side : size.components) require_positive(side, "size");
  require_positive(edge_length, "edge_length");
  std::array<int, 3> divisions{};
  double cubes = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (edge_length > size[axis])
      throw UserError("edge_length is " + shortest(edge_length) +
                      ", but must not be more than the shortest side, " + shortest(size[axis]));
    cubes *= std::round(size[axis] / edge_length);
  }
  require_possible_size(cubes * cells_per_cube(cells), cubes);
  for (std::size_t axis = 0; axis < 3; ++axis)
    divisions[axis] = static_cast<int>(std::lround(size[axis] / edge_length));
  return generate_box(size, divisions, cells);
}

Mesh generate_box(const Vec3d& size, const std::array<int, 3>& divisions, BoxCells cells,
                  const std::array<int, 2>& hole) {
  for (const double side : size.components) require_positive(side, "size");
  double cubes = 1;
  for (const int n : divisions) {
    if (n < 1)
      throw UserError("divisions are " + std::to_string(n) + ", but must be at least 1 along each axis");
    cubes *= n;
  }
  require_possible_size(cubes * cells_per_cube(cells), cubes);

  require_hole_in_the_middle(divisions, hole);
  const Grid grid(size, divisions, hole);
  Mesh mesh;
  for (int k = 0; k <= divisions[2]; ++k)
    for (int j = 0; j <= divisions[1]; ++j)
      for (int i = 0; i <= divisions[0]; ++i) mesh.nodes.push_back(grid.position(i, j, k));
  CellBlock block;
  block.type = cell_type(cells);
  for_each_cube(grid, [&](int i, int j, int k) {
    if (cells == BoxCells::bcc) mesh.nodes.push_back(grid.position(i + 0.5, j + 0.5, k + 0.5));
    if (!grid.has_cube(i, j, k)) return;
    if (cells == BoxCells::bcc) {
      add_bcc_cells(block, grid, i, j, k);
    } else {
      add_cube(block, cells, grid.corners(i, j, k), (i + j + k) % 2 != 0);
    }
  });
  block.region.assign(block.nodes.size() / static_cast<std::size_t>(node_count(block.type)), 0);
  mesh.cells.push_back(std::move(block));
  mesh.regions = {"body"};
  mesh.node_sets.push_back({"surface", boundary_nodes(mesh)});
  add_face_sets(mesh, grid);
  drop_unused_nodes(mesh);  // those in the hole
  return mesh;
}

}  // namespace evert
