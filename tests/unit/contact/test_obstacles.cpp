#include "evert/contact/obstacle.hpp"

#include <gtest/gtest.h>

#include "distance_function.hpp"
#include <numbers>

namespace evert {
namespace {

template <class Surface>
Obstacle moving(Surface surface, const RigidState& start) {
  return {"obstacle", 0.3, std::make_unique<Surface>(surface), std::make_unique<UniformMotion>(start)};
}

TEST(HalfSpace, IsADistanceWithItsNormalNormalised) {
  const HalfSpace tilted({{0.1, -0.2, 0.3}}, {{1, 2, -2}});
  test::expect_distance_function(tilted);
  EXPECT_NEAR(tilted.signed_distance({{0.1, -0.2, 0.3}}), 0, 1e-16);
}

TEST(Sphere, IsADistanceWithANormalAtItsCentre) {
  const Sphere sphere(0.7);
  test::expect_distance_function(sphere);
  EXPECT_NEAR(norm(sphere.normal({})), 1, 1e-15);
  EXPECT_DOUBLE_EQ(sphere.signed_distance({}), -0.7);
}

TEST(Obstacle, MovesWithItsVelocity) {
  auto rising = moving(HalfSpace({}, {{0, 1, 0}}), {.velocity = {3, 2, 0}});
  rising.move_to({.end = 0.5, .dt = 0.1});
  EXPECT_NEAR(rising.signed_distance({{5, 1, 7}}), 0, 1e-15);
  test::expect_distance_function(rising);
  EXPECT_EQ(rising.velocity({{1, 2, 3}}), (Vec3d{3, 2, 0}));
  EXPECT_NEAR(norm(rising.mean_velocity({{1, 2, 3}}) - Vec3d{3, 2, 0}), 0, 1e-14);
}

TEST(Obstacle, IsNotThereAfterItIsTakenAway) {
  auto plane = moving(HalfSpace({}, {{0, 1, 0}}), {});
  plane.remove_after(0.3);
  plane.move_to({.end = 0.3, .dt = 0.1});
  EXPECT_TRUE(plane.bounds().contains({{1, -1, 0}}));
  plane.move_to({.end = 0.4, .dt = 0.1});
  EXPECT_FALSE(plane.is_there());
  EXPECT_FALSE(plane.bounds().contains({{1, -1, 0}}));
  EXPECT_FALSE(plane.bounds().overlaps({{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}}));
}

TEST(Obstacle, ContainsItsSurfaceInItsBounds) {
  auto ball = moving(Sphere(0.5), {.origin = {1, 2, 3}, .velocity = {-1, 0, 0}});
  ball.move_to({.end = 2, .dt = 0.1});
  EXPECT_NEAR(norm(ball.bounds().lower - Vec3d{-1.5, 1.5, 2.5}), 0, 1e-15);
  EXPECT_NEAR(norm(ball.bounds().upper - Vec3d{-0.4, 2.5, 3.5}), 0, 1e-15) << "it has come from there";
  test::expect_distance_function(ball);
  EXPECT_TRUE(moving(HalfSpace({}, {{0, 1, 0}}), {}).bounds().contains({{1e300, -1e300, 0}}));
}

TEST(Obstacle, TurnsAboutItsOrigin) {
  constexpr double quarter = std::numbers::pi / 2;
  auto plane =
      moving(HalfSpace({{1, 0, 0}}, {{1, 0, 0}}), {.origin = {0, 5, 0}, .angular_velocity = {0, 0, quarter}});
  plane.move_to({.end = 1, .dt = 1});  // by a quarter of a turn
  EXPECT_NEAR(plane.signed_distance({{7, 6.5, 7}}), 0.5, 1e-14);
  EXPECT_NEAR(norm(plane.normal({}) - Vec3d{0, 1, 0}), 0, 1e-15);
  EXPECT_NEAR(norm(plane.velocity({{1, 5, 0}}) - Vec3d{0, quarter, 0}), 0, 1e-15);
  EXPECT_NEAR(norm(plane.mean_velocity({{0, 6, 0}}) - Vec3d{-1, 1, 0}), 0, 1e-15) << "from (1, 5, 0)";
}

TEST(RotationBy, IsARotationAtEveryAngle) {
  for (const double angle : {0.0, 1e-300, 1e-9, 1e-3, 1.0, 3.0, std::numbers::pi, 1e3}) {
    const auto r = rotation_by(angle * Vec3d{2. / 3, -1. / 3, 2. / 3});
    EXPECT_LE(norm(transpose_times(r, r) - identity<double>()), 1e-14) << angle;
    EXPECT_NEAR(determinant(r), 1, 1e-14) << angle;
  }
}

}  // namespace
}  // namespace evert
