#include "evert/trade/point_locator.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evert::trade {
namespace {

double linear(const Vec3d& x) { return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2]; }

double value_at(const DistributedMesh& mesh, const PointLocator::Place& place) {
  double sum = 0;
  for (std::size_t a = 0; a < place.count; ++a)
    sum += place.weights[a] * linear(mesh.rest_positions[static_cast<std::size_t>(place.nodes[a])]);
  return sum;
}

DistributedMesh one_cell(CellType type, std::vector<Vec3d> corners) {
  DistributedMesh mesh;
  mesh.rest_positions = std::move(corners);
  mesh.regions = {"body.core"};
  LocalCells cells{.type = type, .region = 0, .nodes = {}, .global_ids = {0}};
  for (std::size_t a = 0; a < mesh.rest_positions.size(); ++a)
    cells.nodes.push_back(static_cast<LocalIndex>(a));
  mesh.cells.push_back(std::move(cells));
  return mesh;
}

const std::vector<Vec3d> warped_hex{{0, 0, 0},   {1, 0.1, 0},   {1.2, 1, 0.1}, {0, 0.9, 0},
                                    {0, 0.1, 1}, {0.9, 0, 1.1}, {1, 1, 1},     {0.1, 1, 0.9}};

/// Linear fields are kept by every element, inside and outside.
void expect_linear(const DistributedMesh& mesh, const Vec3d& point, bool inside) {
  const PointLocator locator(mesh);
  const auto place = locator.locate({"body", point});
  EXPECT_NEAR(value_at(mesh, place), linear(point), 1e-12);
  if (inside)
    EXPECT_EQ(place.outside, 0);
  else
    EXPECT_GT(place.outside, 0);
}

TEST(PointLocator, KeepsLinearFieldsInsideAndJustOutside) {
  const auto hex = one_cell(CellType::hex8, warped_hex);
  expect_linear(hex, {0.3, 0.6, 0.4}, true);
  expect_linear(hex, {1.25, 0.5, 0.5}, false);
  const auto tet = one_cell(CellType::tet4, {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 1}});
  expect_linear(tet, {0.2, 0.3, 0.1}, true);
  expect_linear(tet, {-0.1, 0.3, 0.1}, false);
  const auto wedge =
      one_cell(CellType::wedge6, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1.5, 0, 1}, {0, 1, 1.2}});
  expect_linear(wedge, {0.3, 0.3, 0.5}, true);
  expect_linear(wedge, {0.3, 0.3, 1.3}, false);
}

TEST(PointLocator, FarOutsideTheNearestNodeCounts) {
  const auto hex = one_cell(CellType::hex8, warped_hex);
  const auto place = PointLocator(hex).locate({"body", {10, 10, 10}});
  EXPECT_EQ(value_at(hex, place), linear({1, 1, 1}));
  EXPECT_NEAR(place.outside, 9 * std::sqrt(3.0), 1e-12);
}

TEST(PointLocator, KnowsOnlyCellsOfTheBody) {
  const auto hex = one_cell(CellType::hex8, warped_hex);
  EXPECT_TRUE(std::isinf(PointLocator(hex).locate({"other", {0.5, 0.5, 0.5}}).outside));
  EXPECT_EQ(body_of_region("arm.bone"), "arm");
  EXPECT_EQ(body_of_region("arm"), "arm");
}

/// A row of cubes, every point in exactly the one it is in.
TEST(PointLocator, FindsTheCellAmongMany) {
  constexpr int cells = 50;
  DistributedMesh mesh;
  mesh.regions = {"row"};
  for (int i = 0; i <= cells; ++i)
    for (const auto& [y, z] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      mesh.rest_positions.push_back({static_cast<double>(i), y, z});
  LocalCells row{.type = CellType::hex8, .region = 0, .nodes = {}, .global_ids = {}};
  for (int i = 0; i < cells; ++i) {
    for (const int corner : {0, 4, 5, 1, 3, 7, 6, 2}) row.nodes.push_back(4 * i + corner);
    row.global_ids.push_back(i);
  }
  mesh.cells.push_back(row);
  const PointLocator locator(mesh);
  for (int i = 0; i < cells; ++i) {
    const auto place = locator.locate({"row", {i + 0.25, 0.5, 0.75}});
    EXPECT_EQ(place.outside, 0);
    EXPECT_EQ(place.nodes[0], 4 * i);
    EXPECT_NEAR(value_at(mesh, place), linear({i + 0.25, 0.5, 0.75}), 1e-11);
  }
}

}  // namespace
}  // namespace evert::trade
