#include "evert/core/error.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quadratic.hpp"
#include "evert/mesh/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace evert {
namespace {

TEST(Quadratic, KeepsTheShapeAndSharesTheMiddleNodes) {
  Mesh mesh = generate_box({1, 1, 1}, {2, 2, 2}, BoxCells::tet6);
  const GlobalIndex corners = mesh.node_count(), cells = mesh.cell_count();
  make_quadratic(mesh);
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_EQ(mesh.cells[0].type, CellType::tet10);
  EXPECT_EQ(mesh.cell_count(), cells);
  // Edges of 2×2×2 cubes, diagonals of faces and of cubes.
  EXPECT_EQ(mesh.node_count(), corners + 3 * 2 * 3 * 3 + 3 * 3 * 2 * 2 + 2 * 2 * 2);
  const auto& nodes = mesh.cells[0].nodes;
  constexpr std::size_t ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t cell = 0; cell < nodes.size(); cell += 10) {
    const auto at = [&](std::size_t a) { return mesh.nodes[static_cast<std::size_t>(nodes[cell + a])]; };
    for (std::size_t e = 0; e < 6; ++e) EXPECT_EQ(at(4 + e), 0.5 * (at(ends[e][0]) + at(ends[e][1])));
  }
}

TEST(Quadratic, NodeSetsGainTheNodesBetweenTheirOwn) {
  Mesh mesh = generate_box({1, 1, 1}, {2, 2, 2}, BoxCells::tet6);
  make_quadratic(mesh);
  for (const auto& set : mesh.node_sets) {
    EXPECT_EQ(set.nodes.size(), set.name == "surface" ? 98U : 25U) << set.name << ": 5×5 nodes of a face";
    EXPECT_TRUE(std::is_sorted(set.nodes.begin(), set.nodes.end()));
  }
}

TEST(Quadratic, OtherCellsAreRefused) {
  Mesh mesh = generate_box({1, 1, 1}, {1, 1, 1}, BoxCells::hex8);
  try {
    make_quadratic(mesh);
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(), "only tetrahedra can be made quadratic, but the mesh has cells of type hex8");
  }
}

}  // namespace
}  // namespace evert
