#include "evert/mesh/partition.hpp"

#include "evert/core/error.hpp"

#include <gtest/gtest.h>

#include "test_meshes.hpp"
#include <algorithm>

namespace evert {
namespace {

/// Quadrature points of each rank.
std::vector<int> loads(const Mesh& mesh, const std::vector<int>& part, int ranks) {
  std::vector<int> result(static_cast<std::size_t>(ranks));
  auto rank = part.begin();
  for (const auto& block : mesh.cells)
    for (GlobalIndex cell = 0; cell < block.size(); ++cell)
      result[static_cast<std::size_t>(*rank++)] += quadrature_points(block.type);
  return result;
}

TEST(Partition, GivesEveryRankACellHoweverFewThereAre) {
  for (const auto& mesh : {test::tet_cube(1), test::tet_cube(2), test::mixed_row(5)})
    for (int ranks = 1; ranks <= mesh.cell_count(); ++ranks) {
      const auto part = partition_cells(mesh, ranks);
      ASSERT_EQ(static_cast<GlobalIndex>(part.size()), mesh.cell_count());
      const auto load = loads(mesh, part, ranks);
      EXPECT_EQ(std::count(load.begin(), load.end(), 0), 0) << ranks << " ranks";
    }
}

TEST(Partition, BalancesQuadraturePointsOfMixedMeshes) {
  // 384 tetrahedra of one point and, apart from them, 48 hexahedra of eight.
  auto mesh = test::tet_cube(4);
  const auto row = test::mixed_row(48);
  CellBlock bricks = row.cells[1];
  for (auto& node : bricks.nodes) node += mesh.node_count();
  bricks.region.assign(bricks.region.size(), 0);
  mesh.nodes.insert(mesh.nodes.end(), row.nodes.begin(), row.nodes.end());
  mesh.cells.push_back(bricks);
  const auto load = loads(mesh, partition_cells(mesh, 4), 4);
  EXPECT_LT(*std::max_element(load.begin(), load.end()), 1.1 * (384 + 48 * 8) / 4);
}

TEST(Partition, CutsFewFaces) {
  const auto mesh = test::tet_cube(8);
  const auto part = partition_cells(mesh, 2);
  // Nodes that both sides touch: a plane through the cube has 81; a random partition would share nearly all
  // of 729.
  std::vector<int> sides(mesh.nodes.size());
  const auto& nodes = mesh.cells.front().nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sides[static_cast<std::size_t>(nodes[i])] |= 1 << part[i / 4];
  EXPECT_LT(std::count(sides.begin(), sides.end(), 3), 150);
}

TEST(Partition, RefusesMoreRanksThanCells) {
  EXPECT_THROW(static_cast<void>(partition_cells(test::single_tet(), 2)), UserError);
  EXPECT_THROW(static_cast<void>(partition_cells(Mesh{}, 1)), UserError);
}

}  // namespace
}  // namespace evert
