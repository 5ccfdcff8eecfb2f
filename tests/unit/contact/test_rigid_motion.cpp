// Prescribed motions: their places, and that their velocities are the rates of their places.
#include "evert/contact/keyframed_motion.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace evert {
namespace {

constexpr double pi = std::numbers::pi;
const RigidState start{rotation_by({0.3, -0.2, 0.5}), {1, 2, 3}, {}, {}};
const Vec3d about{0.5, 1.5, -1};

/// Of a point of the body, from places alone: central differences of fourth order.
Vec3d rate_of_place(const RigidMotion& motion, const Vec3d& local, double t, double h) {
  const auto at = [&](double time) { return motion.at(time).to_world(local); };
  return (1 / (12 * h)) * (8 * (at(t + h) - at(t - h)) - (at(t + 2 * h) - at(t - 2 * h)));
}

void expect_velocities_of_places(const RigidMotion& motion, std::initializer_list<double> times) {
  for (const double t : times)
    for (const Vec3d& local : {Vec3d{}, Vec3d{1, 0, 0}, Vec3d{0, -2, 1}}) {
      const auto state = motion.at(t);
      const auto expected = rate_of_place(motion, local, t, 1e-3);
      EXPECT_LE(norm(state.velocity_at(state.to_world(local)) - expected), 1e-8 * (1 + norm(expected)))
          << "at t = " << t;
      EXPECT_LE(norm(transpose_times(state.rotation, state.rotation) - identity<double>()), 1e-14);
    }
}

TEST(UniformMotion, TurnsAboutAPointThatMovesOn) {
  auto moving = start;
  moving.angular_velocity = {0.4, 2, -1};
  moving.velocity = Vec3d{1, 0, 0.5} + cross(moving.angular_velocity, start.origin - about);
  const UniformMotion motion(moving, about);
  expect_velocities_of_places(motion, {0, 0.7, 3});
  const auto local = start.to_body(about);
  EXPECT_LE(norm(motion.at(2).to_world(local) - (about + Vec3d{2, 0, 1})), 1e-14) << "the pivot";
  EXPECT_LE(norm(motion.at(0).origin - start.origin), 1e-15);
}

TEST(Oscillation, IsASineOfPlaceAndAngle) {
  const Oscillation motion(start, about, {0.1, 0, -0.2}, {0, 0.5, 0.3}, 0.5, 0.2);
  expect_velocities_of_places(motion, {0, 0.3, 0.77, 1.4});
  const auto peak = motion.at((pi / 2 - 0.2) / pi);
  EXPECT_LE(norm(peak.to_world(start.to_body(about)) - (about + Vec3d{0.1, 0, -0.2})), 1e-14);
  EXPECT_LE(norm(peak.rotation - rotation_by({0, 0.5, 0.3}) * start.rotation), 1e-14);
  EXPECT_LE(norm(peak.angular_velocity), 1e-14);
}

std::vector<PoseKey> wild_keys() {
  return {{-1, {0, 0, 0}, {}},
          {0.5, {1, 0.2, -0.3}, quaternion_by({0, 0, 2})},
          {0.7, {1.5, 0.1, -0.3}, quaternion_by({0.5, 1, 2})},
          {2, {1.2, 0.1, -0.3}, {-quaternion_by({-1, 1, 1}).w, -quaternion_by({-1, 1, 1}).v}},
          {3, {1.2, 0.1, -0.3}, quaternion_by({-1, 1, 1})},
          {4, {0, 0, 0}, quaternion_by({3, 0, 0})}};
}

TEST(KeyframedMotion, IsExactAtItsTimes) {
  const KeyframedMotion motion(start, about, wild_keys());
  for (const auto& key : wild_keys()) {
    const auto state = motion.at(key.time);
    const auto expected = displaced(start, about, {rotation_matrix(key.rotation), key.position, {}, {}});
    EXPECT_LE(norm(state.origin - expected.origin), 1e-15 * norm(expected.origin)) << key.time;
    EXPECT_LE(norm(state.rotation - expected.rotation), 1e-14) << key.time;
  }
}

TEST(KeyframedMotion, HasTheVelocitiesOfItsPlaces) {
  expect_velocities_of_places(KeyframedMotion(start, about, wild_keys()),
                              {-0.9, -0.3, 0.4, 0.55, 0.65, 0.75, 1.2, 1.9, 2.5, 3.2, 3.9, 5});
}

TEST(KeyframedMotion, HasContinuousVelocities) {
  const KeyframedMotion motion(start, about, wild_keys());
  for (const auto& key : wild_keys()) {
    constexpr double moment = 1e-9;
    const auto before = motion.at(key.time - moment), after = motion.at(key.time + moment);
    EXPECT_LE(norm(after.velocity - before.velocity), 1e-6) << key.time;
    EXPECT_LE(norm(after.angular_velocity - before.angular_velocity), 1e-6) << key.time;
  }
  EXPECT_EQ(motion.at(-5).velocity, Vec3d{});
  EXPECT_EQ(motion.at(7).angular_velocity, Vec3d{});
}

TEST(KeyframedMotion, HoldsStillAndNeverOvershoots) {
  const KeyframedMotion motion(start, about, wild_keys());
  for (int i = 0; i <= 100; ++i) {
    const auto held = motion.at(2 + 0.01 * i);
    EXPECT_LE(norm(held.velocity) + norm(held.angular_velocity), 1e-13);
    const auto rising = motion.at(-1 + 0.015 * i);
    const auto moved = rising.to_world(start.to_body(about)) - about;
    EXPECT_GE(moved[0], -1e-15);
    EXPECT_LE(moved[0], 1 + 1e-15);
  }
}

TEST(KeyframedMotion, TurnsEvenlyAboutAFixedAxisBetweenEvenKeys) {
  std::vector<PoseKey> keys;
  for (int i = 0; i < 12; ++i) keys.push_back({0.5 * i, {}, quaternion_by({0, 1.0 * i, 0})});
  const KeyframedMotion motion({}, {}, keys);
  for (const double t : {0.6, 1.0, 2.3, 4.9})
    EXPECT_LE(norm(motion.at(t).angular_velocity - Vec3d{0, 2, 0}), 1e-12) << t;
}

TEST(KeyframedMotion, OfOneKeyIsAPlace) {
  const KeyframedMotion motion(start, about, {{1, {0, 1, 0}, {}}});
  for (const double t : {0.0, 1.0, 2.0}) EXPECT_LE(norm(motion.at(t).origin - Vec3d{1, 3, 3}), 1e-15);
}

}  // namespace
}  // namespace evert
