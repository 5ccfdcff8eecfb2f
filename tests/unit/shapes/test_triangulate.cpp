#include "evert/core/error.hpp"
#include "evert/shapes/combined.hpp"
#include "evert/shapes/gear.hpp"
#include "evert/shapes/solids.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

namespace evert {
namespace {

double volume(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles) {
    const auto at = [&](std::size_t c) { return surface.points[static_cast<std::size_t>(t[c])]; };
    sum += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return sum;
}

/// Every edge is used as often in one direction as in the other.
bool is_closed(const TriangleSurface& surface) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const auto& t : surface.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto a = t[c], b = t[(c + 1) % 3];
      uses[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  return std::ranges::all_of(uses, [](const auto& use) { return use.second == 0; });
}

TEST(Triangulate, GivesClosedSurfacesOfTheRightVolume) {
  constexpr double pi = std::numbers::pi;
  const auto expect_volume = [](const ImplicitSurface& solid, double exact, double tolerance) {
    const auto surface = triangulate(solid);
    EXPECT_TRUE(is_closed(surface));
    EXPECT_NEAR(volume(surface) / exact, 1, tolerance);
    double farthest = 0;
    for (const auto& point : surface.points)
      farthest = std::max(farthest, std::abs(solid.signed_distance(point)));
    const auto size = solid.bounds().upper - solid.bounds().lower;
    EXPECT_LT(farthest, 0.01 * std::max({size[0], size[1], size[2]}));
  };
  // chords of a circle of 48 cells lose up to a hundredth; flat sides and sharp edges lose nothing
  expect_volume(Sphere(1), 4 * pi / 3, 0.01);
  expect_volume(Torus(0.5, 0.2), 2 * pi * pi * 0.5 * 0.04, 0.02);
  expect_volume(Box({1, 2, 0.5}), 1, 1e-9);
  expect_volume(Box({1, 1e-3, 1}), 1e-3, 1e-9);
  expect_volume(cylinder(0.4, 2), pi * 0.16 * 2, 0.02);
  expect_volume(Cone(0.5, 0, 1), pi * 0.25 / 3, 0.02);
}

TEST(Triangulate, DrawsGears) {
  const Gear gear(8, 0.25, 0.4, 0.2);
  const auto surface = triangulate(gear, {.cells = 96});
  EXPECT_TRUE(is_closed(surface));
  for (const auto& point : surface.points) EXPECT_NEAR(gear.signed_distance(point), 0, 0.005);
}

TEST(Triangulate, DrawsASquareOfAHalfSpace) {
  const Vec3d point{1, 2, 3}, normal{0.6, 0.8, 0};
  const auto surface = triangulate(HalfSpace(point, normal), {.extent = 4});
  ASSERT_EQ(surface.triangles.size(), 2U);
  double area = 0;
  for (const auto& t : surface.triangles) {
    const auto at = [&](std::size_t c) { return surface.points[static_cast<std::size_t>(t[c])]; };
    const auto twice = cross(at(1) - at(0), at(2) - at(0));
    area += norm(twice) / 2;
    EXPECT_NEAR(dot(twice, normal) / norm(twice), 1, 1e-15) << "it faces outwards";
  }
  EXPECT_NEAR(area, 16, 1e-14);
  for (const auto& corner : surface.points) EXPECT_NEAR(dot(corner - point, normal), 0, 1e-15);
}

TEST(Triangulate, CutsWhatGoesOnForEver) {
  std::vector<Solid> parts;
  parts.push_back(std::make_unique<HalfSpace>(Vec3d{}, Vec3d{0, 1, 0}));
  parts.push_back(std::make_unique<Sphere>(0.5));
  const Union solid(std::move(parts));
  const auto surface = triangulate(solid, {.extent = 2});
  EXPECT_GT(surface.triangles.size(), 100U);
  for (const auto& point : surface.points) EXPECT_NEAR(solid.signed_distance(point), 0, 0.02);
  std::vector<Solid> apart;
  apart.push_back(std::make_unique<Sphere>(1));
  apart.push_back(std::make_unique<Placed>(std::make_unique<Sphere>(1), identity<double>(), Vec3d{5, 0, 0}));
  EXPECT_THROW((void)triangulate(Intersection(std::move(apart))), UserError);
}

}  // namespace
}  // namespace evert
