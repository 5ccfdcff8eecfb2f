// The level sets of obstacles against closed forms and brute force, and the meshes that fill them.
#include "evert/mesh/generators.hpp"
#include "evert/mesh/quality.hpp"
#include "evert/shapes/figure.hpp"
#include "evert/shapes/gear.hpp"
#include "evert/shapes/triangle_solid.hpp"

#include "tests/support/verify.hpp"
#include "tests/unit/shapes/level_set_checks.hpp"

namespace evert {
namespace {

std::vector<test::Subject> exact_solids() {
  const auto subject = []<class Shape>(const char* name, Shape shape) {
    const auto solid = std::make_shared<Shape>(std::move(shape));
    return test::Subject{name, solid, [=](const Vec3d& x) { return solid->signed_distance(x) < 0; }};
  };
  return {subject("sphere", Sphere(0.7)),
          subject("box", Box({1, 2, 0.5})),
          subject("plate", Box({1, 1e-3, 1})),
          subject("rounded box", Box({1, 2, 0.5}, 0.1)),
          subject("ellipsoid", Ellipsoid({1, 0.5, 1.3})),
          subject("needle", Ellipsoid({0.02, 1, 0.02})),
          subject("capsule", Capsule(0.3, 1)),
          subject("cylinder", cylinder(0.4, 2)),
          subject("torus", Torus(0.5, 0.2)),
          subject("cone", Cone(0.5, 0, 1)),
          subject("truncated cone", Cone(0.2, 0.8, 0.5)),
          subject("gear", Gear(12, 0.3, 0.4, 0.2))};
}

double longest_side(const ImplicitSurface& solid) {
  const auto size = solid.bounds().upper - solid.bounds().lower;
  return std::max({size[0], size[1], size[2]});
}

/// φ is the distance when no point of the surface is nearer, and the way along the normal ends on it.
TEST(ObstacleShapes, AreExact) {
  double too_far = 0, missed = 0;
  for (const auto& subject : exact_solids()) {
    const auto& solid = *subject.solid;
    const auto points = test::surface_points(subject, 2000);
    test::RandomPoints random(test::grown(solid.bounds(), 0.3));
    for (int n = 0; n < 2000; ++n) {
      const auto x = random();
      const double phi = solid.signed_distance(x);
      const double over = std::abs(phi) - test::brute_force_distance(points, x);
      too_far = std::max(too_far, over / longest_side(solid));
      missed =
          std::max(missed, std::abs(solid.signed_distance(x - phi * solid.normal(x))) / longest_side(solid));
    }
  }
  EXPECT_LT(too_far, 1e-12);
  EXPECT_LT(missed, 1e-12);
  test::verify("obstacle shapes: 12 solids, largest excess of the distance over brute force, over the size",
               "0", too_far, "1e-12");
  test::verify("obstacle shapes: 12 solids, largest miss of the surface along the normal, over the size", "0",
               missed, "1e-12");
}

TEST(ObstacleShapes, TrianglesAreExactOnAThinPlate) {
  const Box box({1, 1e-3, 1});
  TriangleSurface surface;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5e-3, 0.5e-3})
      for (const double z : {-0.5, 0.5}) surface.points.push_back({x, y, z});
  surface.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                       {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  require_closed(surface, "plate");
  const TriangleSolid solid(surface);
  double worst = 0;
  int wrong_signs = 0;
  test::RandomPoints near(test::grown({{-0.5, -2e-3, -0.5}, {0.5, 2e-3, 0.5}}, 0.005));
  for (int n = 0; n < 100000; ++n) {
    const auto x = near();
    const double phi = solid.signed_distance(x), exact = box.signed_distance(x);
    wrong_signs += (phi < 0) != (exact < 0) ? 1 : 0;
    worst = std::max(worst, std::abs(phi - exact));
  }
  EXPECT_EQ(wrong_signs, 0);
  EXPECT_LT(worst, 1e-15);
  test::verify("obstacle of triangles: plate 1 mm thick and 1 m long, wrong sides of 100,000 points", "0",
               wrong_signs, "0");
  test::verify("obstacle of triangles: the same, largest error of the distance [m]", "0", worst, "1e-15");
}

TEST(ObstacleShapes, AreFilledWithGoodTetrahedra) {
  const auto smallest_angle = [](const ImplicitSurface& solid, double edge_length) {
    return measure_quality(generate(solid, "shape", edge_length)).dihedral_angle.smallest;
  };
  const double in_gear = smallest_angle(Gear(12, 0.3, 0.4, 0.2), 0.03);
  const double in_figure = smallest_angle(*figure(1), 0.02);
  EXPECT_GT(in_gear, 9);
  EXPECT_GT(in_figure, 9);
  test::verify("mesh of a gear: smallest dihedral angle [degrees]", "> 9", in_gear, "-");
  test::verify("mesh of the figure: smallest dihedral angle [degrees]", "> 9", in_figure, "-");
}

}  // namespace
}  // namespace evert
