#include "evert/contact/push_out.hpp"
#include "evert/contact/velocity_constraints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace evert {
namespace {

Vec3d random_unit(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vec3d v{normal(random), normal(random), normal(random)};
  return (1 / norm(v)) * v;
}

/// The nearest point of an intersection of half-spaces to the origin, by Dykstra's alternating projections.
Vec3d nearest_by_dykstra(const std::vector<Bound>& bounds) {
  Vec3d x{};
  std::vector<Vec3d> corrections(bounds.size());
  for (int round = 0; round < 20000; ++round)
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      const auto y = x + corrections[k];
      x = y + std::max(0.0, bounds[k].least - dot(bounds[k].normal, y)) * bounds[k].normal;
      corrections[k] = y - x;
    }
  return x;
}

TEST(PushOut, IsTheSmallestChangeThatObeysAllBounds) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> depth(-0.2, 1);
  for (int sample = 0; sample < 60; ++sample) {
    // Around one direction, so that there is a way out.
    const auto out = random_unit(random);
    std::vector<Bound> bounds(1 + static_cast<std::size_t>(sample) % 5);
    for (auto& bound : bounds) {
      const auto towards = 1.2 * out + random_unit(random);
      bound = {(1 / norm(towards)) * towards, depth(random)};
    }
    const auto found = push_out(bounds);
    EXPECT_FALSE(found.pinched);
    EXPECT_LE(norm(found.change - nearest_by_dykstra(bounds)), 1e-6) << sample;
    for (const auto& bound : bounds) EXPECT_GE(dot(bound.normal, found.change), bound.least - 1e-12);
    std::shuffle(bounds.begin(), bounds.end(), random);
    EXPECT_LE(norm(push_out(bounds).change - found.change), 1e-12) << "in any order";
  }
}

TEST(PushOut, LeavesWhatIsFreeAlone) {
  const std::vector<Bound> bounds{{{0, 1, 0}, -0.1}, {{1, 0, 0}, 0}};
  EXPECT_EQ(push_out(bounds).change, Vec3d{});
  EXPECT_EQ(push_out({}).change, Vec3d{});
}

TEST(PushOut, MeetsBodiesThatLeaveNoRoomInTheMiddle) {
  // Between walls at x >= 0.3 and x <= −0.1, on a floor at y >= 0.2.
  std::vector<Bound> bounds{{{1, 0, 0}, 0.3}, {{-1, 0, 0}, 0.1}, {{0, 1, 0}, 0.2}};
  const auto found = push_out(bounds);
  EXPECT_TRUE(found.pinched);
  EXPECT_LE(norm(found.change - Vec3d{0.1, 0.2, 0}), 1e-8);
  std::swap(bounds[0], bounds[2]);
  EXPECT_LE(norm(push_out(bounds).change - found.change), 1e-12);
}

TEST(SplitOver, AddsUpToTheVector) {
  std::mt19937_64 random(6);
  std::vector<double> shares;
  for (int sample = 0; sample < 100; ++sample) {
    const std::array normals{random_unit(random), random_unit(random)};
    const auto tangent = projector_off(normals);
    const std::vector<Bound> bounds{{normals[0], 0}, {normals[1], 0}};
    split_over(bounds, tangent, 2 * normals[0] + 3 * normals[1] + 7 * (tangent * random_unit(random)),
               shares);
    EXPECT_NEAR(shares[0], 2, 1e-9);
    EXPECT_NEAR(shares[1], 3, 1e-9);
  }
  const std::vector<Bound> twice{{{0, 1, 0}, 0}, {{0, 1, 0}, 0}};
  split_over(twice, projector_off(std::array{Vec3d{0, 1, 0}}), {5, 4, 0}, shares);
  EXPECT_NEAR(shares[0], 2, 1e-15) << "bodies with one surface share alike";
  EXPECT_NEAR(shares[1], 2, 1e-15);
}

}  // namespace
}  // namespace evert
