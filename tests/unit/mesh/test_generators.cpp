#include "evert/mesh/boundary.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quality.hpp"
#include "evert/mesh/repair.hpp"
#include "evert/mesh/round_bar.hpp"
#include "evert/shapes/figure.hpp"
#include "evert/shapes/gear.hpp"
#include "evert/shapes/solids.hpp"

#include "mesh_files.hpp"
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace evert::test {
namespace {

const NodeSet& node_set(const Mesh& mesh, std::string_view name) {
  const auto found = std::ranges::find(mesh.node_sets, name, &NodeSet::name);
  if (found == mesh.node_sets.end()) throw std::runtime_error("no node set " + std::string(name));
  return *found;
}

const Vec3d& position(const Mesh& mesh, GlobalIndex node) {
  return mesh.nodes[static_cast<std::size_t>(node)];
}

TEST(Box, fills_its_volume_with_every_kind_of_cell) {
  const Vec3d size{1, 2, 3};
  const std::array divisions{3, 4, 5};
  constexpr GlobalIndex cubes = 60;
  const std::vector<std::tuple<BoxCells, CellType, GlobalIndex>> kinds{
      {BoxCells::hex8, CellType::hex8, cubes},
      {BoxCells::wedge6, CellType::wedge6, 2 * cubes},
      {BoxCells::tet5, CellType::tet4, 5 * cubes},
      {BoxCells::tet6, CellType::tet4, 6 * cubes},
      {BoxCells::bcc, CellType::tet4, 12 * cubes}};
  for (const auto& [cells, type, count] : kinds) {
    const auto mesh = generate_box(size, divisions, cells);
    ASSERT_EQ(mesh.cells.size(), 1U);
    EXPECT_EQ(mesh.cells[0].type, type);
    EXPECT_EQ(mesh.cell_count(), count);
    EXPECT_NO_THROW(require_positive_volumes(mesh, "box"));
    const auto quality = measure_quality(mesh);
    EXPECT_NEAR(quality.total_volume, 6, 1e-13);
    EXPECT_EQ(quality.components, 1);
    EXPECT_EQ(quality.unused_nodes, 0);
    EXPECT_EQ(quality.duplicate_nodes, 0);
    // A closed boundary of the six sides: cells fit together.
    GlobalIndex squares = 0;
    for (const auto& face : boundary_faces(mesh)) squares += face.corners == 4 ? 2 : 1;
    EXPECT_EQ(squares, 2 * 2 * (3 * 4 + 4 * 5 + 5 * 3)) << static_cast<int>(cells);
  }
}

TEST(Box, has_a_hole_through_its_middle) {
  for (const auto cells : {BoxCells::hex8, BoxCells::wedge6, BoxCells::tet5, BoxCells::tet6, BoxCells::bcc}) {
    const auto mesh = generate_box({5, 6, 2}, {5, 6, 2}, cells, {.hole = {3, 2}});
    EXPECT_NO_THROW(require_positive_volumes(mesh, "ring"));
    const auto quality = measure_quality(mesh);
    EXPECT_NEAR(quality.total_volume, 2 * (5 * 6 - 3 * 2), 1e-12);
    EXPECT_EQ(quality.components, 1);
    EXPECT_EQ(quality.unused_nodes, 0);
    GlobalIndex squares = 0;
    for (const auto& face : boundary_faces(mesh)) squares += face.corners == 4 ? 2 : 1;
    // Above and below, around, and in the hole.
    EXPECT_EQ(squares, 2 * (2 * (5 * 6 - 3 * 2) + 2 * 2 * (5 + 6) + 2 * 2 * (3 + 2)));
    for (const auto& p : mesh.nodes)
      EXPECT_FALSE(std::abs(p[0]) < 1.5 && std::abs(p[1]) < 1) << "in the hole";
    EXPECT_EQ(node_set(mesh, "z_max").nodes.size(), 6U * 7U - 2U * 1U);
  }
}

TEST(Box, becomes_a_cross) {
  for (const auto cells : {BoxCells::hex8, BoxCells::wedge6, BoxCells::tet5, BoxCells::tet6, BoxCells::bcc}) {
    const auto mesh = generate_box({5, 6, 4}, {10, 12, 8}, cells, {.cross = 4});
    EXPECT_NO_THROW(require_positive_volumes(mesh, "cross"));
    const auto quality = measure_quality(mesh);
    EXPECT_NEAR(quality.total_volume, (10 + 12 + 8 - 2 * 4) * 4 * 4 * 0.125, 1e-10);
    EXPECT_EQ(quality.components, 1);
    EXPECT_EQ(quality.unused_nodes, 0);
    EXPECT_EQ(node_set(mesh, "x_max").nodes.size(), 25U) << "the end of a bar";
  }
  EXPECT_EQ(generate_box({3, 3, 3}, {60, 60, 60}, BoxCells::hex8, {.cross = 20}).cell_count(), 56000);
}

TEST(Box, names_its_sides) {
  const auto mesh = generate_box({1, 2, 3}, {3, 4, 5}, BoxCells::bcc);
  EXPECT_EQ(node_set(mesh, "x_min").nodes.size(), 5U * 6U);
  EXPECT_EQ(node_set(mesh, "y_max").nodes.size(), 4U * 6U);
  EXPECT_EQ(node_set(mesh, "z_min").nodes.size(), 4U * 5U);
  for (const auto node : node_set(mesh, "x_min").nodes) EXPECT_EQ(position(mesh, node)[0], -0.5);
  for (const auto node : node_set(mesh, "y_max").nodes) EXPECT_EQ(position(mesh, node)[1], 1.0);
  for (const auto node : node_set(mesh, "z_max").nodes) EXPECT_EQ(position(mesh, node)[2], 1.5);
  EXPECT_EQ(node_set(mesh, "surface").nodes, boundary_nodes(mesh));
}

TEST(Box, takes_the_edge_length_that_divides_it) {
  EXPECT_EQ(generate_box({1, 0.5, 0.3}, 0.11, BoxCells::hex8).cell_count(), 9 * 5 * 3);
}

TEST(Box, of_the_bcc_lattice_has_the_best_angles) {
  const auto angles = measure_quality(generate_box({1, 1, 1}, 0.25, BoxCells::bcc)).dihedral_angle;
  EXPECT_NEAR(angles.smallest, 45, 1e-9);
  EXPECT_NEAR(angles.largest, 120, 1e-9);
}

/// A solid of which only the sign of the function counts.
class FunctionSolid final : public ImplicitSurface {
 public:
  FunctionSolid(std::function<double(const Vec3d&)> value, const Vec3d& half)
      : value_(std::move(value)), half_(half) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override { return value_(x); }
  [[nodiscard]] Vec3d normal(const Vec3d& /*x*/) const override { return {0, 1, 0}; }
  [[nodiscard]] Box3 bounds() const override { return {-half_, half_}; }

 private:
  std::function<double(const Vec3d&)> value_;
  Vec3d half_;
};

FunctionSolid box_with_hole() {
  return {[](const Vec3d& p) {
            const double box = std::max({std::abs(p[0]) - 1, std::abs(p[1]) - 0.8, std::abs(p[2]) - 0.6});
            return std::max(box, 0.35 - std::hypot(p[0], p[1]));
          },
          {1, 0.8, 0.6}};
}

struct Stuffed {
  std::string name;
  std::shared_ptr<const ImplicitSurface> shape;
  double volume;  // [m³]
  int handles;    // of the surface
};

template <class Shape>
Stuffed stuffed(const char* name, Shape shape, double volume, int handles) {
  return {name, std::make_shared<Shape>(std::move(shape)), volume, handles};
}

std::vector<Stuffed> shapes() {
  constexpr double pi = std::numbers::pi;
  return {
      stuffed("ball", Sphere(1), 4 * pi / 3, 0),
      stuffed("torus", Torus(0.5, 0.2), 2 * pi * pi * 0.5 * 0.04, 1),
      stuffed("thin torus", Torus(1, 0.1), 2 * pi * pi * 0.01, 1),
      stuffed("thick torus", Torus(0.5, 0.45), 2 * pi * pi * 0.5 * 0.45 * 0.45, 1),
      stuffed("cylinder", cylinder(0.4, 2), pi * 0.16 * 2, 0),
      stuffed("ellipsoid", Ellipsoid({1, 0.5, 1.3}), 4 * pi / 3 * 0.65, 0),
      stuffed("capsule", Capsule(0.3, 1), pi * 0.09 + 4 * pi / 3 * 0.027, 0),
      stuffed("rounded box", Box({1, 1, 1}, 0.4),
              0.008 + 6 * 0.04 * 0.4 + 12 * 0.2 * pi * 0.04 + 4 * pi / 3 * 0.064, 0),
      stuffed("truncated cone", Cone(1, 0.5, 1), pi / 3 * 1.75, 0),
      stuffed("box with a hole", box_with_hole(), 2 * 1.6 * 1.2 - pi * 0.35 * 0.35 * 1.2, 1),
  };
}

double thinnest_side(const ImplicitSurface& shape) {
  const auto size = shape.bounds().upper - shape.bounds().lower;
  return std::min({size[0], size[1], size[2]});
}

/// The bound that issue 2 asks for is 8 degrees; the method promises 9 whatever the shape.
TEST(RoundBar, is_the_same_body_of_hexahedra_and_of_tetrahedra) {
  for (const double inner_radius : {0.0, 0.4}) {
    RoundBar bar{
        .radius = 1, .length = 3, .inner_radius = inner_radius, .quarter = 3, .rings = 2, .layers = 4};
    const auto hexes = generate_round_bar(bar);
    bar.cell = RoundBarCells::tet6;
    const auto tets = generate_round_bar(bar);
    EXPECT_EQ(hexes.cells[0].type, CellType::hex8);
    EXPECT_EQ(tets.cells[0].type, CellType::tet4);
    EXPECT_EQ(tets.cell_count(), 6 * hexes.cell_count());
    for (const auto* mesh : {&hexes, &tets}) {
      EXPECT_NO_THROW(require_positive_volumes(*mesh, "bar"));
      const auto quality = measure_quality(*mesh);
      // A polygon of twelve corners around, and within.
      const double area = 6 * std::sin(std::numbers::pi / 6) * (1 - inner_radius * inner_radius);
      EXPECT_NEAR(quality.total_volume, 3 * area, 1e-12);
      EXPECT_EQ(quality.components, 1);
      EXPECT_EQ(quality.duplicate_nodes, 0);
    }
    // Neighbours agree about the diagonals of their faces.
    EXPECT_EQ(boundary_faces(tets).size(), 2 * boundary_faces(hexes).size());
    EXPECT_EQ(node_set(tets, "surface").nodes, node_set(hexes, "surface").nodes);
  }
}

TEST(Stuffing, keeps_every_dihedral_angle_above_9_degrees) {
  for (const auto& [name, shape, volume, handles] : shapes()) {
    const double thinnest = thinnest_side(*shape);
    for (const double parts : {2.0, 2.7, 4.0, 6.3, 9.1}) {
      const auto mesh = generate(*shape, name, thinnest / parts);
      const auto quality = measure_quality(mesh);
      EXPECT_GT(quality.dihedral_angle.smallest, 9) << name << ' ' << parts;
      EXPECT_LT(quality.dihedral_angle.largest, 165) << name << ' ' << parts;
      EXPECT_NO_THROW(require_positive_volumes(mesh, name));
      EXPECT_EQ(quality.unused_nodes + quality.duplicate_nodes, 0) << name << ' ' << parts;
    }
  }
}

/// Surfaces that are nowhere aligned with the lattice, and one that is rough at its scale.
TEST(Stuffing, keeps_the_bound_for_tilted_and_rough_shapes) {
  double smallest = 180;
  for (int seed = 0; seed < 12; ++seed) {
    const double a = 0.37 * seed;
    const FunctionSolid tilted(
        [=](const Vec3d& p) {
          const double across = std::cos(a) * p[0] + std::sin(a) * std::cos(2 * a) * p[1] +
                                std::sin(a) * std::sin(2 * a) * p[2];
          return std::max(std::abs(across) - 0.31, std::hypot(p[0], p[1], p[2]) - 1);
        },
        {1, 1, 1});
    const FunctionSolid rough(
        [=](const Vec3d& p) {
          return std::hypot(p[0], p[1], p[2]) - 0.8 +
                 0.15 * std::sin(17 * p[0] + a) * std::sin(19 * p[1] + 2 * a) * std::sin(23 * p[2] + 3 * a);
        },
        {1, 1, 1});
    for (const auto* shape : {&tilted, &rough})
      smallest = std::min(smallest, measure_quality(generate(*shape, "slab", 0.14)).dihedral_angle.smallest);
  }
  EXPECT_GT(smallest, 9);
}

TEST(Stuffing, converges_to_the_shape_and_its_topology) {
  for (const auto& [name, shape, volume, handles] : shapes()) {
    const double thinnest = thinnest_side(*shape);
    const auto mesh = generate(*shape, name, thinnest / 8);
    const auto quality = measure_quality(mesh);
    EXPECT_NEAR(quality.total_volume / volume, 1, 0.04) << name;
    EXPECT_EQ(quality.components, 1) << name;
    // Euler's formula of the closed surface.
    const auto faces = quality.boundary_faces;
    const auto surface = static_cast<GlobalIndex>(node_set(mesh, "surface").nodes.size());
    EXPECT_EQ(surface - 3 * faces / 2 + faces, 2 - 2 * handles) << name;
    for (const auto node : node_set(mesh, "surface").nodes)
      EXPECT_NEAR(shape->signed_distance(position(mesh, node)), 0, 1e-12) << name;
  }
}

TEST(Stuffing, gives_the_tori_of_the_demo) {
  EXPECT_EQ(generate(Torus(0.5, 0.2), "torus", 0.077).cell_count(), 11048);
  const auto large = generate(Torus(0.5, 0.2), "torus", 0.035).cell_count();
  EXPECT_GT(large, 114000);
  EXPECT_LT(large, 116000);
}

TEST(Stuffing, is_repeatable) {
  const auto a = generate(Torus(0.5, 0.2), "torus", 0.1);
  const auto b = generate(Torus(0.5, 0.2), "torus", 0.1);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.cells[0].nodes, b.cells[0].nodes);
}

TEST(Generators, refuse_impossible_sizes) {
  const double nan = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  const auto expect = [](auto work, std::string_view fault) {
    expect_user_error([&] { static_cast<void>(work()); }, {fault});
  };
  expect([&] { return Sphere(0); }, "radius is 0, but must be a positive finite length");
  expect([&] { return Sphere(nan); }, "radius is nan");
  expect([&] { return cylinder(1, -2); }, "length is -2");
  expect([&] { return Ellipsoid({1, infinite, 1}); }, "radii is inf");
  expect([&] { return Torus(0.2, 0.5); }, "minor_radius is 0.5, but must be less than major_radius, 0.2");
  expect([&] { return generate(Sphere(1), "ball", 0); }, "edge_length is 0");
  expect([&] { return generate(Sphere(1), "ball", nan); }, "edge_length is nan");
  expect([&] { return generate(Sphere(1), "ball", 1.5); },
         "edge_length is 1.5, but must be at most 1, half the shortest extent");
  expect([&] { return generate(Sphere(1), "ball", 1e-4); },
         "GB of this machine are allowed: choose a larger edge_length");
  expect([&] { return generate(Sphere(1), "ball", 1e-300); }, "choose a larger edge_length");
  expect(
      [&] {
        return generate_box({1, 1, 1}, 2, BoxCells::hex8);
      },
      "must not be more than the shortest side, 1");
  expect([&] { return generate_box({1, 0, 1}, 0.5, BoxCells::hex8); }, "size is 0");
  expect([&] { return generate_box({1, 1, 1}, 1e-6, BoxCells::hex8); }, "choose a larger edge_length");
  expect([&] { return generate_box({1, 1, 1}, {2, 0, 2}, BoxCells::hex8); }, "must be at least 1");
  expect([&] { return generate_box({1, 1, 1}, {4, 4, 1}, BoxCells::hex8, {4, 2}); }, "less than all");
  expect([&] { return generate_box({1, 1, 1}, {4, 4, 1}, BoxCells::hex8, {2, 1}); }, "both must be odd");
  expect([&] { return generate_box({1, 1, 1}, {100000, 100000, 100000}, BoxCells::hex8); }, "2^31 cells");
  const auto constant = [](double value) {
    return FunctionSolid([=](const Vec3d&) { return value; }, {1, 1, 1});
  };
  expect([&] { return generate(constant(nan), "hole", 0.5); }, "gives no number at");
  expect([&] { return generate(constant(1), "void", 0.5); }, "nothing is inside");
  expect([&] { return generate(*figure(1), "figure", 0.05); }, "hang on an edge or a corner only");
  expect([&] { return generate(constant(-1), "all", 0.5); }, "reaches out of the box");
  expect(
      [&] {
        return generate(HalfSpace({}, {0, 1, 0}), "half space", 0.5);
      },
      "a side of the box of the half space is inf, but must be a positive finite length");
}

}  // namespace
}  // namespace evert::test
