// Generated meshes with bad elements: what they are made of, that they close, and that they are those of
// PHYSICS 9.
#include "evert/mesh/bad_meshes.hpp"
#include "evert/mesh/boundary.hpp"
#include "evert/mesh/cell_geometry.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/quality.hpp"
#include "evert/mesh/repair.hpp"
#include "evert/shapes/solids.hpp"

#include "mesh_files.hpp"
#include "tests/support/shared_meshes.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace evert::test {
namespace {

const std::vector<GlobalIndex>& node_set(const Mesh& mesh, std::string_view name) {
  return std::ranges::find(mesh.node_sets, name, &NodeSet::name)->nodes;
}

/// Vertices less edges plus faces of the surface: 2 for each body without holes, if it is closed.
GlobalIndex euler_number(const Mesh& mesh) {
  const auto faces = static_cast<GlobalIndex>(boundary_faces(mesh).size());
  return static_cast<GlobalIndex>(boundary_nodes(mesh).size()) - 3 * faces / 2 + faces;
}

using Corners = std::array<std::array<double, 3>, 4>;

/// The corners of all cells from the lowest corner of the mesh, to 1e-9 of its size, in an order that does
/// not depend on numbers.
std::multiset<Corners> cells_of(const Mesh& mesh) {
  const auto quality = measure_quality(mesh);
  const double size = norm(quality.upper - quality.lower);
  std::multiset<Corners> all;
  for_each_cell(mesh, [&](GlobalIndex, const CellBlock&, std::size_t, std::span<const Vec3d> corners) {
    Corners cell{};
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t k = 0; k < 3; ++k)
        cell[a][k] = std::round((corners[a][k] - quality.lower[k]) / size * 1e9);
    std::ranges::sort(cell);
    all.insert(cell);
  });
  return all;
}

void expect_shared(const Mesh& mesh, const std::string& name) {
  const auto path = shared_mesh(name);
  if (!path) GTEST_SKIP() << name << " is not in EVERT_SHARED_MESHES";
  const auto shared = read_mesh(*path);
  EXPECT_EQ(mesh.node_count(), shared.node_count());
  EXPECT_EQ(cells_of(mesh), cells_of(shared));
}

TEST(WedgeStack, has_six_wedges_on_21_edges) {
  const auto mesh = generate_wedge_stack({});
  EXPECT_EQ(mesh.node_count(), 11);
  EXPECT_EQ(mesh.cell_count(), 8);
  EXPECT_NO_THROW(require_positive_volumes(mesh, "stack"));
  EXPECT_EQ(euler_number(mesh), 2);
  EXPECT_NEAR(measure_quality(mesh).total_volume, std::sqrt(3.0) / 4 * (2 / 19.0) + 2 / (6 * std::sqrt(2.0)),
              1e-15);
  std::set<std::pair<GlobalIndex, GlobalIndex>> of_wedges;
  for_each_cell(mesh,
                [&](GlobalIndex, const CellBlock& block, std::size_t c, std::span<const Vec3d> corners) {
                  const auto range = edge_range(CellType::tet4, corners);
                  EXPECT_NEAR(range.longest, 1, 0.0014);  // of a diagonal, √(1 + 1/19²)
                  if (range.shortest > 0.9) return;
                  EXPECT_NEAR(range.shortest, 1 / 19.0, 1e-15);
                  for (const auto& [i, j] : edges_of_tet)
                    of_wedges.insert(std::minmax(block.nodes[4 * c + i], block.nodes[4 * c + j]));
                });
  EXPECT_EQ(of_wedges.size(), 21U);
  EXPECT_EQ(node_set(mesh, "z_max").size() + node_set(mesh, "z_min").size(), 2U);
}

TEST(WedgeStack, has_as_many_layers_as_asked_for) {
  const auto mesh = generate_wedge_stack({.edge_length = 0.2, .edge_ratio = 80, .layers = 5});
  EXPECT_EQ(mesh.node_count(), 3 * 6 + 2);
  EXPECT_EQ(mesh.cell_count(), 3 * 5 + 2);
  EXPECT_EQ(euler_number(mesh), 2);
  EXPECT_NEAR(measure_quality(mesh).edges.shortest, 0.2 / 80, 1e-15);
}

TEST(WedgeStack, is_that_of_the_prototype) { expect_shared(generate_wedge_stack({}), "wedge_stack.msh"); }

TEST(CutCube, is_two_bodies_that_touch) {
  const auto mesh = generate_cut_cube({});
  const auto quality = measure_quality(mesh);
  EXPECT_EQ(quality.nodes, 187);
  EXPECT_EQ(quality.cells, 409);
  EXPECT_EQ(quality.components, 2);
  EXPECT_NEAR(quality.total_volume, 64, 0.5);  // nodes of the faces have moved off them
  EXPECT_NO_THROW(require_positive_volumes(mesh, "cube"));
  EXPECT_EQ(euler_number(mesh), 4);
  EXPECT_EQ(node_set(mesh, "surface"), boundary_nodes(mesh));
  const auto &lower = node_set(mesh, "lower_cut"), &upper = node_set(mesh, "upper_cut");
  ASSERT_EQ(lower.size(), 39U);
  ASSERT_EQ(upper.size(), 39U);
  const auto places = [&](const std::vector<GlobalIndex>& nodes) {
    std::set<std::array<double, 3>> all;
    for (const auto node : nodes) all.insert(mesh.nodes[static_cast<std::size_t>(node)].components);
    return all;
  };
  EXPECT_EQ(places(lower), places(upper)) << "to the last bit";
  for (const auto& place : places(lower))
    EXPECT_NEAR(0.35 * place[0] + 0.2 * place[1] + place[2], 0.13, 1e-14);
}

TEST(CutCube, is_that_of_the_prototype) { expect_shared(generate_cut_cube({}), "cut_cube.msh"); }

/// Also through corners, along faces, and where tetrahedra are cut in every way.
TEST(CutCube, closes_wherever_it_is_cut) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<CutCube> cubes{{.normal = {0, 0, 1}, .through = {}, .snap = 0},
                             {.normal = {1, 1, 1}, .through = {}, .snap = 0},
                             {.normal = {1, -1, 0}, .through = {}, .snap = 0.1}};
  for (int trial = 0; trial < 100; ++trial)
    cubes.push_back({.normal = {any(random), any(random), any(random)},
                     .through = {any(random), any(random), any(random)},
                     .snap = 0.1 * (trial % 3)});
  for (const auto& cube : cubes) {
    const auto mesh = generate_cut_cube(cube);
    const auto quality = measure_quality(mesh);
    EXPECT_EQ(quality.components, 2);
    EXPECT_EQ(euler_number(mesh), 4);
    EXPECT_NO_THROW(require_positive_volumes(mesh, "cube"));
    EXPECT_NEAR(quality.total_volume, 64, cube.snap == 0 ? 1e-10 : 1.0);
    EXPECT_EQ(node_set(mesh, "lower_cut").size(), node_set(mesh, "upper_cut").size());
    for (const auto* face : {"z_min", "z_max"}) EXPECT_GE(node_set(mesh, face).size(), 25U);
  }
}

TEST(CutCube, keeps_the_flat_tetrahedra_that_a_plane_near_to_nodes_makes) {
  const auto thin =
      measure_quality(generate_cut_cube({.normal = {0, 0, 1}, .through = {0, 0, 1e-6}, .snap = 0}));
  EXPECT_GT(thin.aspect_ratio.largest, 1e5);
  const auto snapped = measure_quality(generate_cut_cube({.normal = {0, 0, 1}, .through = {0, 0, 1e-6}}));
  EXPECT_LT(snapped.aspect_ratio.largest, 3);
}

constexpr std::array<std::array<int, 4>, 3> opposite_edges{{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};

int slivers_of(const Mesh& mesh) {
  int count = 0;
  for_each_cell(mesh, [&](GlobalIndex, const CellBlock&, std::size_t, std::span<const Vec3d> x) {
    // The pair of opposite edges that is nearest to meeting.
    double nearest = 1;
    for (const auto& [i, j, k, l] : opposite_edges) {
      const auto at = [&](int n) { return x[static_cast<std::size_t>(n)]; };
      const Vec3d one = at(j) - at(i), other = at(l) - at(k), across = cross(one, other);
      nearest = std::min(
          nearest, std::abs(dot(across, at(k) - at(i))) / norm(across) / std::max(norm(one), norm(other)));
    }
    count += nearest <= 0.1 ? 1 : 0;
  });
  return count;
}

TEST(SliverBall, has_the_share_of_slivers_that_it_is_asked_for) {
  const auto round = measure_quality(generate(Sphere(1), "ball", 0.2));
  for (const double share : {0.0, 0.01, 0.05}) {
    const auto mesh = generate_sliver_ball({.radius = 1, .edge_length = 0.2, .slivers = share});
    const auto quality = measure_quality(mesh);
    EXPECT_EQ(quality.nodes, round.nodes);
    EXPECT_NEAR(static_cast<double>(quality.cells - round.cells) / static_cast<double>(quality.cells), share,
                1e-4);
    EXPECT_EQ(slivers_of(mesh), quality.cells - round.cells);
    EXPECT_NEAR(quality.total_volume, round.total_volume, 1e-12);
    EXPECT_EQ(quality.components, 1);
    EXPECT_EQ(euler_number(mesh), 2);
    EXPECT_NO_THROW(require_positive_volumes(mesh, "ball"));
  }
}

TEST(SliverBall, is_repeatable_and_another_for_each_seed) {
  const SliverBall ball{.radius = 1, .edge_length = 0.25, .slivers = 0.02};
  auto other = ball;
  other.seed = 2;
  const auto a = generate_sliver_ball(ball), b = generate_sliver_ball(ball), c = generate_sliver_ball(other);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.cells[0].nodes, b.cells[0].nodes);
  EXPECT_NE(a.nodes, c.nodes);
}

TEST(BadMeshes, refuse_what_they_cannot_be) {
  const double nan = std::nan("");
  const auto expect = [](auto work, std::string_view fault) {
    expect_user_error([&] { static_cast<void>(work()); }, {fault});
  };
  expect([&] { return generate_wedge_stack({.edge_length = 0}); }, "edge_length is 0");
  expect([&] { return generate_wedge_stack({.edge_ratio = nan}); },
         "edge_ratio is nan, but must be positive");
  expect([&] { return generate_wedge_stack({.layers = 0}); }, "layers are 0, but must be at least 1");
  expect([&] { return generate_cut_cube({.size = -1}); }, "size is -1");
  expect([&] { return generate_cut_cube({.normal = {0, 0, 0}}); }, "normal must have a direction");
  expect([&] { return generate_cut_cube({.normal = {0, nan, 0}}); }, "normal must have a direction");
  expect([&] { return generate_cut_cube({.through = {0, 0, 9}}); }, "the plane cuts nothing");
  expect([&] { return generate_cut_cube({.through = {0, 0, nan}}); }, "through must be finite");
  expect([&] { return generate_cut_cube({.snap = 0.6}); }, "snap is 0.6, but must be from 0 to 0.5");
  expect([&] { return generate_sliver_ball({.radius = 0, .edge_length = 0.1}); }, "radius is 0");
  expect([&] { return generate_sliver_ball({.radius = 1, .edge_length = 3}); }, "edge_length is 3");
  expect([&] { return generate_sliver_ball({.radius = 1, .edge_length = 0.2, .slivers = nan}); },
         "slivers is nan");
  expect([&] { return generate_sliver_ball({.radius = 1, .edge_length = 0.3, .thinnest = 0.1}); },
         "have room");
}

}  // namespace
}  // namespace evert::test
