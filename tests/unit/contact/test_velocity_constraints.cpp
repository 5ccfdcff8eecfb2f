#include "evert/contact/velocity_constraints.hpp"
#include "evert/math/nodal.hpp"

#include <gtest/gtest.h>

#include <random>

namespace evert {
namespace {

Vec3d random_unit(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vec3d v{normal(random), normal(random), normal(random)};
  return (1 / norm(v)) * v;
}

void expect_projector(const Mat3d& p, double dimension) {
  EXPECT_NEAR(norm(p * p - p), 0, 1e-14);
  EXPECT_NEAR(norm(p - transpose(p)), 0, 1e-15);
  EXPECT_NEAR(trace(p), dimension, 1e-14);
}

TEST(Projector, TakesOutTheSpanOfItsDirections) {
  std::mt19937_64 random(2);
  for (int sample = 0; sample < 200; ++sample) {
    const std::array<Vec3d, 2> normals{random_unit(random), random_unit(random)};
    const auto p = projector_off(normals);
    expect_projector(p, 1);
    for (const auto& n : normals) EXPECT_NEAR(norm(p * n), 0, 1e-13);
    const std::array<Vec3d, 3> repeated{normals[0], normals[0], -normals[0]};
    expect_projector(projector_off(repeated), 2);
  }
  const std::array<Vec3d, 4> all{{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{1, 1, 0}}}};
  EXPECT_NEAR(norm(projector_off(all)), 0, 1e-15);
  expect_projector(projector_off({}), 3);
}

TEST(Join, KeepsTheOrderOfNodesAndBothConstraints) {
  const auto off = [](const Vec3d& n) { return projector_off(std::array{n}); };
  const std::vector<NodeConstraint> first{{1, off({{1, 0, 0}}), {{2, 0, 0}}},
                                          {5, off({{0, 1, 0}}), {{0, 3, 0}}}};
  const std::vector<NodeConstraint> second{{0, off({{0, 0, 1}}), {{0, 0, 4}}},
                                           {5, off({{0, 0.6, 0.8}}), {{0, 0.6, 0.8}}}};
  std::vector<NodeConstraint> joined;
  join(first, second, joined);
  ASSERT_EQ(joined.size(), 3U);
  EXPECT_EQ(joined[0].node, 0);
  EXPECT_EQ(joined[1].node, 1);
  EXPECT_EQ(joined[2].node, 5);
  expect_projector(joined[2].free, 1);
  EXPECT_NEAR(joined[2].prescribed[1], 3, 1e-15) << "the first list wins where the two disagree";
  for (const auto& c : joined) EXPECT_NEAR(norm(c.free * c.prescribed), 0, 1e-15);
}

TEST(Impose, KeepsTheFreePartAndSetsTheRest) {
  std::vector<double> values{1, 2, 3, 4, 5, 6};
  const std::vector<NodeConstraint> constraints{
      {1, projector_off(std::array{Vec3d{{0, 1, 0}}}), {{0, -7, 0}}}};
  impose(constraints, values);
  EXPECT_EQ(values, (std::vector<double>{1, 2, 3, 4, -7, 6}));
  project(constraints, values);
  EXPECT_EQ(values, (std::vector<double>{1, 2, 3, 4, 0, 6}));
}

}  // namespace
}  // namespace evert
