#include "evert/contact/prescribed_motion.hpp"

#include <gtest/gtest.h>

namespace evert {
namespace {

TEST(PrescribedMotion, InterpolatesItsKeyframes) {
  PrescribedNodes group;
  group.nodes = {2, 7};
  group.keyframes = {{1, {{0, 0, 0}}}, {2, {{4, 0, 0}}}};
  PrescribedMotion motion({group});
  EXPECT_EQ(motion.at(0).front().prescribed[0], 0);
  EXPECT_DOUBLE_EQ(motion.at(1.25).front().prescribed[0], 1);
  EXPECT_EQ(motion.at(9).back().prescribed[0], 4);
  EXPECT_EQ(motion.at(9).back().node, 7);
  EXPECT_EQ(motion.at(9).back().free, Mat3d{});
}

TEST(PrescribedMotion, LeavesUnnamedAxesAndTimesFree) {
  PrescribedNodes group;
  group.nodes = {0};
  group.keyframes = {{0, {{1, 2, 3}}}};
  group.axes = {false, true, false};
  group.from = 1;
  group.until = 2;
  PrescribedMotion motion({group});
  EXPECT_TRUE(motion.at(0.5).empty());
  EXPECT_TRUE(motion.at(2.5).empty());
  const auto constraint = motion.at(1.5).front();
  EXPECT_EQ(constraint.prescribed, (Vec3d{{0, 2, 0}}));
  EXPECT_EQ(constraint.free(0, 0), 1);
  EXPECT_EQ(constraint.free(1, 1), 0);
}

TEST(PrescribedMotion, OfTwoGroupsTheFirstWinsPerComponent) {
  PrescribedNodes first, second;
  first.nodes = second.nodes = {3};
  first.axes = {true, false, false};
  first.keyframes = {{0, {{1, 1, 1}}}};
  second.keyframes = {{0, {{9, 8, 7}}}};
  PrescribedMotion motion({first, second});
  ASSERT_EQ(motion.at(0).size(), 1U);
  const auto prescribed = motion.at(0).front().prescribed;
  EXPECT_NEAR(norm(prescribed - Vec3d{{1, 8, 7}}), 0, 1e-15);
}

TEST(PrescribedMotion, WaysAreTheIntegralOfTheVelocity) {
  PrescribedNodes group{{3}, {{1, {0, 0, 0}}, {2, {2, 0, 0}}, {4, {2, 0, 0}}}};
  PrescribedMotion motion({group});
  const auto way = [&](double begin, double end) { return motion.ways(begin, end).front().prescribed[0]; };
  EXPECT_DOUBLE_EQ(way(0, 1), 0);
  EXPECT_DOUBLE_EQ(way(0, 2), 1);
  EXPECT_DOUBLE_EQ(way(1, 1.5), 0.25);
  EXPECT_DOUBLE_EQ(way(1.5, 3), 0.75 + 2);
  EXPECT_DOUBLE_EQ(way(0, 10), 1 + 16);
  EXPECT_DOUBLE_EQ(way(5, 6), 2);
}

TEST(PrescribedMotion, WaysBeginWithTheirGroupAndEndWithIt) {
  PrescribedNodes group{{0}, {{0, {0, 3, 0}}}, {false, true, false}, 1, 2};
  PrescribedMotion motion({group});
  EXPECT_TRUE(motion.ways(0, 0.5).empty());
  EXPECT_DOUBLE_EQ(motion.ways(0, 1.5).front().prescribed[1], 1.5);
  EXPECT_TRUE(motion.ways(0, 3).empty()) << "free at the end";
}

}  // namespace
}  // namespace evert
