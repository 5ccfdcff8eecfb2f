#include "evert/contact/obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evert {
namespace {

Vec3d random_point(std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 2);
  return {normal(random), normal(random), normal(random)};
}

/// φ is a distance: 1-Lipschitz, its gradient the normal, and a step −φ along it ends on the surface.
void expect_distance_function(const Obstacle& obstacle, double t) {
  std::mt19937_64 random(1);
  for (int sample = 0; sample < 1000; ++sample) {
    const auto x = random_point(random);
    const auto y = random_point(random);
    const double phi = obstacle.signed_distance(x, t);
    EXPECT_LE(std::abs(phi - obstacle.signed_distance(y, t)), norm(x - y) * (1 + 1e-14));
    const auto n = obstacle.normal(x, t);
    EXPECT_NEAR(norm(n), 1, 1e-14);
    EXPECT_NEAR(obstacle.signed_distance(x - phi * n, t), 0, 1e-13);
    constexpr double h = 1e-6;
    EXPECT_NEAR((obstacle.signed_distance(x + h * n, t) - obstacle.signed_distance(x - h * n, t)) / (2 * h),
                1, 1e-8);
  }
}

TEST(HalfSpace, IsADistanceWithItsNormalNormalised) {
  const HalfSpace tilted("tilted", 0, {{0.1, -0.2, 0.3}}, {{1, 2, -2}});
  expect_distance_function(tilted, 0);
  EXPECT_NEAR(tilted.signed_distance({{0.1, -0.2, 0.3}}, 0), 0, 1e-16);
}

TEST(HalfSpace, MovesWithItsVelocity) {
  const HalfSpace rising("rising", 0, {{0, 0, 0}}, {{0, 1, 0}}, {{3, 2, 0}});
  EXPECT_NEAR(rising.signed_distance({{5, 1, 7}}, 0.5), 0, 1e-15);
  expect_distance_function(rising, 0.5);
}

TEST(Sphere, IsADistanceAlsoWhileMoving) {
  const Sphere sphere("ball", 0.3, {{1, 2, 3}}, 0.7, {{-1, 0, 0}});
  expect_distance_function(sphere, 0);
  expect_distance_function(sphere, 2);
}

TEST(Sphere, HasANormalAtItsCentre) {
  const Sphere sphere("ball", 0.3, {{1, 2, 3}}, 0.7);
  EXPECT_NEAR(norm(sphere.normal({{1, 2, 3}}, 0)), 1, 1e-15);
  EXPECT_DOUBLE_EQ(sphere.signed_distance({{1, 2, 3}}, 0), -0.7);
}

}  // namespace
}  // namespace evert
