#include "evert/contact/mass_properties.hpp"
#include "evert/contact/rigid_motion.hpp"
#include "evert/contact/support_points.hpp"
#include "evert/shapes/combined.hpp"
#include "evert/shapes/solids.hpp"

#include <gtest/gtest.h>

namespace evert {
namespace {

/// By counting small cubes.
MassProperties brute_force(const ImplicitSurface& solid) {
  constexpr int cells = 160;
  const auto [lower, upper] = solid.bounds();
  const auto size = (1.0 / cells) * (upper - lower);
  const double volume = size[0] * size[1] * size[2];
  MassProperties sum;
  Vec3d first{};
  Mat3d second{};
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const auto x = lower + Vec3d{(i + 0.5) * size[0], (j + 0.5) * size[1], (k + 0.5) * size[2]};
        if (solid.signed_distance(x) >= 0) continue;
        sum.mass += volume;
        first += volume * x;
        second += volume * outer(x, x);
      }
  sum.center = (1 / sum.mass) * first;
  second -= sum.mass * outer(sum.center, sum.center);
  sum.inertia = trace(second) * identity<double>() - second;
  return sum;
}

void expect_alike(const MassProperties& found, const MassProperties& expected, double tolerance) {
  EXPECT_NEAR(found.mass / expected.mass, 1, tolerance);
  EXPECT_LE(norm(found.center - expected.center), tolerance);
  EXPECT_LE(norm(found.inertia - expected.inertia), tolerance * norm(expected.inertia));
}

Placed lopsided() {
  std::vector<Solid> parts;
  parts.push_back(std::make_unique<Box>(Vec3d{1, 0.5, 0.4}));
  parts.push_back(
      std::make_unique<Placed>(std::make_unique<Sphere>(0.4), identity<double>(), Vec3d{0.5, 0.2, 0}));
  return {std::make_unique<Union>(std::move(parts)), rotation_by({0.3, 0, 1.2}), {0.3, -1, 2}};
}

TEST(MassOf, IsWhatCountingGives) {
  expect_alike(mass_of(Sphere(0.7)), brute_force(Sphere(0.7)), 2e-3);
  expect_alike(mass_of(Box({1, 2, 0.5})), brute_force(Box({1, 2, 0.5})), 2e-3);
  expect_alike(mass_of(Box({1, 2, 0.5}, 0.2)), brute_force(Box({1, 2, 0.5}, 0.2)), 4e-3);
  expect_alike(mass_of(Capsule(0.3, 1.1)), brute_force(Capsule(0.3, 1.1)), 2e-3);
  expect_alike(mass_of(Ellipsoid({1, 0.5, 0.3})), brute_force(Ellipsoid({1, 0.5, 0.3})), 4e-3);
  expect_alike(mass_of(lopsided()), brute_force(lopsided()), 8e-3);
}

TEST(EnclosedMass, IsExactForTriangles) {
  // A box of 12 triangles, far from the origin.
  TriangleSurface surface;
  const Vec3d at{3, -2, 5};
  for (int i = 0; i < 8; ++i)
    surface.points.push_back(at + Vec3d{i & 1 ? 0.5 : -0.5, i & 2 ? 1.0 : -1.0, i & 4 ? 0.25 : -0.25});
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  auto expected = box_mass({1, 2, 0.5});
  expected.center = at;
  expect_alike(enclosed_mass(surface), expected, 1e-14);
}

void expect_supported(const ImplicitSurface& solid, std::size_t count) {
  const auto points = support_points(solid);
  EXPECT_EQ(points.size(), count);
  for (const auto& [center, radius] : points) EXPECT_NEAR(solid.signed_distance(center) + radius, 0, 1e-15);
}

TEST(SupportPoints, LieWithinTheirSolidAndTouchItsSurface) {
  expect_supported(Sphere(0.3), 1);
  expect_supported(Box({1, 2, 3}), 8);
  expect_supported(Capsule(0.3, 1), 3);
  EXPECT_TRUE(support_points(HalfSpace({}, {0, 1, 0})).empty());
  EXPECT_GT(support_points(Ellipsoid({1, 0.5, 0.3})).size(), 100U);
}

}  // namespace
}  // namespace evert
