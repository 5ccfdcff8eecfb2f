#include "evert/core/error.hpp"
#include "evert/io/surface.hpp"
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "../../mpi/mesh/test_meshes.hpp"
#include <map>
#include <numeric>

namespace evert {
namespace {

/// Signed volume inside the surface.
double volume_of(const Surface& surface, const Mesh& mesh) {
  const auto at = [&](std::uint32_t vertex) {
    return mesh.nodes[static_cast<std::size_t>(surface.nodes[vertex])];
  };
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles) volume += dot(at(a), cross(at(b), at(c))) / 6;
  return volume;
}

void expect_closed(const Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;  // an edge is walked once in each direction
  for (const auto& [a, b, c] : surface.triangles)
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      balance[std::minmax(from, to)] += from < to ? 1 : -1;
  for (const auto& [edge, sum] : balance) EXPECT_EQ(sum, 0) << edge.first << '-' << edge.second;
}

TEST(Surface, OfACubeIsClosedAndLooksOutwards) {
  const auto mesh = test::tet_cube(3);
  const auto surface = surface_of(mesh);
  EXPECT_EQ(surface.triangles.size(), 6U * 9U * 2U);
  EXPECT_EQ(surface.nodes.size(), 64U - 8U);
  expect_closed(surface);
  EXPECT_NEAR(volume_of(surface, mesh), 1, 1e-14);
}

TEST(Surface, OfSeveralCellTypesSplitsQuadrilaterals) {
  const auto mesh = test::mixed_row(2);
  const auto surface = surface_of(mesh);
  // The tetrahedron 4; the row of two hexahedra 8 quadrilaterals and an end; the wedge 2 quadrilaterals and 2
  // triangles.
  EXPECT_EQ(surface.triangles.size(), 4U + 2U * 9U + 2U * 2U + 2U);
  expect_closed(surface);
  EXPECT_NEAR(volume_of(surface, mesh), 2 + 0.5 + 1.0 / 6, 1e-14);
}

TEST(Surface, OfQuadraticTetrahedraUsesTheMiddlesOfTheEdges) {
  Mesh mesh = test::single_tet();
  for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}})
    mesh.nodes.push_back(0.5 *
                         (mesh.nodes[static_cast<std::size_t>(a)] + mesh.nodes[static_cast<std::size_t>(b)]));
  mesh.cells = {{CellType::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {0}}};
  const auto surface = surface_of(mesh);
  EXPECT_EQ(surface.triangles.size(), 16U);
  EXPECT_EQ(surface.nodes.size(), 10U);
  expect_closed(surface);
  EXPECT_NEAR(volume_of(surface, mesh), 1.0 / 6, 1e-15);
}

TEST(Surface, OfNoCellsIsEmpty) {
  const auto surface = surface_of(Mesh{});
  EXPECT_TRUE(surface.triangles.empty());
  EXPECT_TRUE(surface.nodes.empty());
}

TEST(Surface, TakesTheSmallestValueOfTheCellsAtAVertex) {
  const auto mesh = test::mixed_row(2);
  const auto surface = surface_of(mesh);
  const std::vector<double> per_cell{-1, 4, 3, 2};  // tetrahedron, hexahedra, wedge at the end of the second
  const auto smallest = smallest_at_vertices(surface, per_cell);
  for (std::size_t v = 0; v < surface.nodes.size(); ++v) {
    const auto& position = mesh.nodes[static_cast<std::size_t>(surface.nodes[v])];
    EXPECT_EQ(smallest[v], position[1] >= 5 ? -1 : position[0] < 1 ? 4 : position[0] < 2 ? 3 : 2);
  }
}

TEST(Surface, IsLeftAloneWhenSmallEnough) {
  const auto mesh = test::tet_cube(2);
  const auto surface = surface_of(mesh);
  const auto same = simplified(surface, mesh.nodes, surface.triangles.size());
  EXPECT_EQ(same.nodes, surface.nodes);
  EXPECT_EQ(same.triangles, surface.triangles);
}

TEST(Surface, KeepsItsShapeWhenSimplified) {
  const auto mesh = generate(Sphere(1), "ball", 0.12);
  const auto surface = surface_of(mesh);
  ASSERT_GT(surface.triangles.size(), 2000U);
  const auto smaller = simplified(surface, mesh.nodes, 600);
  EXPECT_LE(smaller.triangles.size(), 600U);
  EXPECT_GT(smaller.triangles.size(), 300U);
  EXPECT_NEAR(volume_of(smaller, mesh), volume_of(surface, mesh), 0.1 * volume_of(surface, mesh));
  std::vector<double> values(static_cast<std::size_t>(mesh.cell_count()));
  std::iota(values.begin(), values.end(), -1.0);
  for (const double value : smallest_at_vertices(smaller, values))
    EXPECT_LT(value, static_cast<double>(values.size()));
}

TEST(Surface, SimplifiesBodiesApartHoweverNear) {
  auto mesh = test::tet_cube(6);
  const auto second = mesh;
  for (const auto& node : second.nodes) mesh.nodes.push_back(node + Vec3d{{1.001, 0, 0}});
  auto& block = mesh.cells.front();
  for (const auto node : second.cells.front().nodes) block.nodes.push_back(node + second.node_count());
  block.region.resize(2 * block.region.size(), 1);
  mesh.regions = {"left", "right"};
  const auto smaller = simplified(surface_of(mesh), mesh.nodes, 150);
  ASSERT_FALSE(smaller.triangles.empty());
  for (const auto& [a, b, c] : smaller.triangles) {
    EXPECT_EQ(smaller.regions[a], smaller.regions[b]);
    EXPECT_EQ(smaller.regions[b], smaller.regions[c]);
  }
}

TEST(Surface, SimplifiesWhatHasNoArea) {
  auto mesh = test::tet_cube(4);
  for (auto& node : mesh.nodes) node = {{3, 3, 3}};
  const auto surface = simplified(surface_of(mesh), mesh.nodes, 10);
  EXPECT_LE(surface.triangles.size(), 10U);
}

}  // namespace
}  // namespace evert
