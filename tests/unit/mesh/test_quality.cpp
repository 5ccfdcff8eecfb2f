#include "evert/mesh/boundary.hpp"
#include "evert/mesh/cell_geometry.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/partition_quality.hpp"
#include "evert/mesh/quality.hpp"
#include "evert/mesh/repair.hpp"

#include "mesh_files.hpp"
#include <cmath>
#include <sstream>

namespace evert::test {
namespace {

Mesh one_cell(CellType type, std::vector<Vec3d> nodes) {
  Mesh mesh;
  mesh.nodes = std::move(nodes);
  mesh.regions = {"body"};
  CellBlock block{type, {}, {0}};
  for (GlobalIndex i = 0; i < mesh.node_count(); ++i) block.nodes.push_back(i);
  mesh.cells = {block};
  return mesh;
}

Mesh regular_tetrahedron() {
  return one_cell(CellType::tet4, {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}});
}

TEST(Quality, of_the_regular_tetrahedron) {
  auto mesh = regular_tetrahedron();
  reorient(mesh);
  const auto quality = measure_quality(mesh);
  const double angle = std::acos(1.0 / 3) * 180 / std::numbers::pi;
  EXPECT_NEAR(quality.dihedral_angle.smallest, angle, 1e-12);
  EXPECT_NEAR(quality.dihedral_angle.largest, angle, 1e-12);
  EXPECT_NEAR(quality.aspect_ratio.mean, 1, 1e-12);
  EXPECT_NEAR(quality.total_volume, 8.0 / 3, 1e-12);
  EXPECT_NEAR(quality.edges.longest, std::sqrt(8.0), 1e-12);
  EXPECT_EQ(quality.angle_histogram[7], 12);
  EXPECT_EQ(quality.boundary_faces, 4);
  EXPECT_EQ(quality.components, 1);
}

TEST(Quality, of_a_stretched_hexahedron) {
  const auto quality = measure_quality(generate_box({4, 1, 2}, {1, 1, 1}, BoxCells::hex8));
  EXPECT_NEAR(quality.total_volume, 8, 1e-12);
  EXPECT_NEAR(quality.aspect_ratio.largest, 4, 1e-12);
  EXPECT_NEAR(quality.dihedral_angle.smallest, 90, 1e-12);
  EXPECT_EQ(quality.angle_histogram[9], 24);
}

/// Shapes with curved sides, whose volumes are known: the quadrature is that of the elements.
TEST(CellGeometry, integrates_the_volume) {
  // A hexahedron with a tilted lid: the mean of the heights.
  EXPECT_NEAR(
      cell_volume(
          CellType::hex8,
          std::vector<Vec3d>{
              {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 2}, {1, 1, 3}, {0, 1, 2}}),
      2, 1e-14);
  EXPECT_NEAR(
      cell_volume(CellType::wedge6,
                  std::vector<Vec3d>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, {2, 0, 2}, {0, 2, 3}}),
      4, 1e-14);
  const auto mesh = mixed_mesh();
  const std::vector<double> volumes{1.0 / 6, 0.7 / 6, 1.0 / 27, 0.5 / 27, 1.0 / 162};
  for_each_cell(mesh, [&](GlobalIndex cell, const CellBlock& block, std::size_t, std::span<const Vec3d> x) {
    EXPECT_NEAR(cell_volume(block.type, x), volumes[static_cast<std::size_t>(cell)], 1e-15);
  });
}

TEST(Quality, does_not_depend_on_units) {
  for (const double scale : {1e-120, 1e-9, 1e9, 1e90}) {
    auto mesh = mixed_mesh();
    drop_unused_nodes(mesh);
    for (auto& node : mesh.nodes) node = scale * node;
    EXPECT_NO_THROW(require_positive_volumes(mesh, "scaled")) << scale;
    const auto quality = measure_quality(mesh);
    EXPECT_EQ(quality.negative_cells + quality.flat_cells, 0) << scale;
    EXPECT_EQ(quality.duplicate_nodes, 0) << scale;
  }
}

TEST(Quality, counts_faults) {
  Mesh mesh;
  mesh.nodes = {{0, 0, 0},     {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0},
                {1e-13, 0, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}, {5, 5, 6}};
  mesh.regions = {"body"};
  // Sound, negative, flat, and one apart.
  mesh.cells = {{CellType::tet4, {0, 1, 2, 3, 0, 2, 1, 3, 0, 1, 2, 4, 6, 7, 8, 9}, {0, 0, 0, 0}}};
  const auto quality = measure_quality(mesh);
  EXPECT_EQ(quality.negative_cells, 1);
  EXPECT_EQ(quality.flat_cells, 1);
  EXPECT_EQ(quality.first_faulty, (std::vector<GlobalIndex>{1, 2}));
  EXPECT_EQ(quality.unused_nodes, 1);
  EXPECT_EQ(quality.duplicate_nodes, 1);
  EXPECT_EQ(quality.components, 2);
  EXPECT_TRUE(std::isinf(quality.aspect_ratio.largest));
  std::ostringstream text;
  write_quality_text(quality, text);
  for (const auto* line :
       {"negative cells    1  (evert mesh convert -reorient", "flat cells        1", " 1 2  (counted from 0)",
        "unused nodes      1", "duplicate nodes   1", "components        2"})
    EXPECT_NE(text.str().find(line), std::string::npos) << line << "\n" << text.str();
}

TEST(Quality, writes_json) {
  auto mesh = regular_tetrahedron();
  mesh.regions = {"a \"quoted\"\tname"};
  std::ostringstream json;
  write_quality_json(measure_quality(mesh), json);
  for (const auto* part :
       {"\"cells_of_type\": {\"tet4\": 1, \"hex8\": 0, \"wedge6\": 0, \"tet10\": 0}",
        "\"name\": \"a \\\"quoted\\\"\\u0009name\"", "\"negative_cells\": ", "\"duplicate_nodes\": 0"})
    EXPECT_NE(json.str().find(part), std::string::npos) << part << "\n" << json.str();
}

TEST(Repair, offers_to_reorient_and_does) {
  for (const auto cells : {BoxCells::hex8, BoxCells::wedge6, BoxCells::tet5}) {
    auto mesh = generate_box({1, 1, 1}, {2, 1, 1}, cells);
    const auto sound = mesh.cells[0].nodes;
    for (auto& node : mesh.nodes) node[0] = -node[0];
    const auto count = mesh.cell_count();
    expect_user_error([&] { require_positive_volumes(mesh, "mirror.msh"); },
                      {"mirror.msh: " + std::to_string(count) + " of " + std::to_string(count) +
                           " cells have negative volume",
                       "counted from 0: 0, 1", "run 'evert mesh convert in out -reorient'"});
    EXPECT_EQ(reorient(mesh), count);
    EXPECT_NO_THROW(require_positive_volumes(mesh, "mirror.msh"));
    EXPECT_EQ(reorient(mesh), 0);
    // The same cells, only numbered anew.
    auto nodes = mesh.cells[0].nodes;
    auto before = sound;
    std::ranges::sort(nodes);
    std::ranges::sort(before);
    EXPECT_EQ(nodes, before);
  }
}

TEST(Repair, reorients_quadratic_tetrahedra_with_their_edges) {
  auto mesh = mixed_mesh();
  for (auto& node : mesh.nodes) node[1] = -node[1];
  EXPECT_EQ(reorient(mesh), 5);
  EXPECT_NO_THROW(require_positive_volumes(mesh, "mixed"));  // also at the quadrature points of the tet10
}

TEST(Repair, names_cells_with_misplaced_middle_nodes) {
  const auto refused = [](const Mesh& mesh) {
    expect_user_error(
        [&] { require_positive_volumes(mesh, "mixed.msh"); },
        {"mixed.msh: 1 of 5 cells have misplaced middle nodes (counted from 0: 4)", "23 before 13"});
  };
  auto other_order = mixed_mesh();
  auto& nodes = other_order.cells.back().nodes;
  std::swap(nodes[8], nodes[9]);  // as if Gmsh's order were VTK's
  refused(other_order);

  auto astray = mixed_mesh();
  const auto middle = static_cast<std::size_t>(astray.cells.back().nodes[5]);
  astray.nodes[middle] += Vec3d{0.099, 0.099, 0};  // 0.297 of its edge of √2/3
  EXPECT_NO_THROW(require_positive_volumes(astray, "mixed.msh"));
  astray.nodes[middle] += Vec3d{0.002, 0.002, 0};
  refused(astray);
  astray.nodes[middle] = {std::nan(""), 0, 0};
  refused(astray);
}

TEST(Repair, names_cells_that_cannot_be_mended) {
  auto mesh = generate_box({1, 1, 1}, {7, 1, 1}, BoxCells::hex8);
  for (auto& node : mesh.nodes) node[2] = 0;
  expect_user_error([&] { require_positive_volumes(mesh, "flat.msh"); },
                    {"flat.msh: 7 of 7 cells are flat or folded (counted from 0: 0, 1, 2, 3, 4, ...)",
                     "mesh that part again"});
  // One corner pushed through the opposite one: positive in one part, negative in another.
  auto folded = generate_box({1, 1, 1}, {1, 1, 1}, BoxCells::hex8);
  folded.nodes[7] = {-2, -2, -2};
  expect_user_error([&] { require_positive_volumes(folded, "folded.msh"); },
                    {"1 of 1 cells are flat or folded"});
}

TEST(Repair, drops_unused_nodes) {
  auto mesh = mixed_mesh();
  mesh.node_sets.push_back({"gone", {0}});
  const auto tip = mesh.nodes[5];
  EXPECT_EQ(drop_unused_nodes(mesh), 1);
  EXPECT_EQ(mesh.nodes[4], tip);
  EXPECT_EQ(mesh.cells[0].nodes, (std::vector<GlobalIndex>{0, 1, 2, 3, 0, 2, 1, 4}));
  EXPECT_EQ(mesh.node_sets[0].nodes, (std::vector<GlobalIndex>{0, 2, 3}));
  EXPECT_TRUE(mesh.node_sets[2].nodes.empty());
  EXPECT_EQ(drop_unused_nodes(mesh), 0);
}

TEST(Boundary, faces_outwards) {
  for (const auto cells : {BoxCells::hex8, BoxCells::wedge6, BoxCells::tet6, BoxCells::bcc}) {
    const auto mesh = generate_box({1, 1, 1}, {2, 2, 2}, cells);
    double volume = 0;
    for (const auto& face : boundary_faces(mesh)) {
      const auto x = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(face.nodes[i])]; };
      for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(face.corners); ++i)
        volume += dot(x(0), cross(x(i), x(i + 1))) / 6;
    }
    EXPECT_NEAR(volume, 1, 1e-14);
  }
}

TEST(Boundary, of_quadratic_cells_has_their_edge_nodes) {
  auto mesh = mixed_mesh();
  std::erase_if(mesh.cells, [](const CellBlock& block) { return block.type != CellType::tet10; });
  EXPECT_EQ(boundary_nodes(mesh).size(), 10U);
  for (const auto& face : boundary_faces(mesh))
    for (std::size_t e = 0; e < 3; ++e) {
      const auto x = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(face.nodes[i])]; };
      const auto apart = x(3 + e) - 0.5 * (x(e) + x((e + 1) % 3));
      EXPECT_NEAR(dot(apart, apart), 0, 1e-30);
    }
}

TEST(PartitionQuality, counts_what_is_cut) {
  const auto mesh = generate_box({4, 1, 1}, {4, 1, 1}, BoxCells::hex8);
  const std::vector<int> halves{0, 0, 0, 1};
  const auto quality = measure_partition(mesh, halves, 2);
  EXPECT_EQ(quality.edge_cut, 1);
  EXPECT_EQ(quality.ranks[0].cells, 3);
  EXPECT_EQ(quality.ranks[0].work, 24);
  EXPECT_EQ(quality.ranks[0].nodes, 16);
  EXPECT_EQ(quality.ranks[1].cut_faces, 1);
  EXPECT_EQ(quality.ranks[1].neighbours, std::vector<int>{0});
  EXPECT_NEAR(quality.imbalance, 1.5, 1e-15);
}

}  // namespace
}  // namespace evert::test
