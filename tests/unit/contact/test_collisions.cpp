#include "evert/contact/collisions.hpp"
#include "evert/math/nodal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace evert {
namespace {

constexpr StepInterval step{0.1, 0.1};

/// Through the origin at t = 0.
std::unique_ptr<Obstacle> half_space(const char* name, double friction, const Vec3d& normal,
                                     const Vec3d& velocity = {}) {
  return std::make_unique<Obstacle>(name, friction, std::make_unique<HalfSpace>(Vec3d{}, normal),
                                    std::make_unique<UniformMotion>(RigidState{.velocity = velocity}));
}

/// One node of mass 2 over the ground y = 0.
struct OneNode {
  explicit OneNode(double friction, const Vec3d& ground_velocity = {})
      : collisions(ground(friction, ground_velocity), mass) {}

  static std::vector<std::unique_ptr<Obstacle>> ground(double friction, const Vec3d& velocity) {
    std::vector<std::unique_ptr<Obstacle>> obstacles;
    obstacles.push_back(half_space("ground", friction, {{0, 1, 0}}, velocity));
    return obstacles;
  }
  void resolve(std::span<const NodeConstraint> prescribed = {}) {
    collisions.resolve(x, v, predicted, prescribed, step);
  }

  std::vector<double> mass{2.0};
  std::vector<double> x{0, -0.01, 0}, v{1, -3, 0}, predicted{1, -3, 0};
  Collisions collisions;
};

TEST(Collisions, LeaveNodesOutsideAlone) {
  OneNode node(0.5);
  node.x = {0, 1e-12, 0};
  const auto before = node.x;
  node.resolve();
  EXPECT_EQ(node.x, before);
  EXPECT_EQ(node.collisions.contacts(), 0);
}

TEST(Collisions, MoveToTheSurfaceAndStopTheNormalVelocity) {
  OneNode node(0);
  node.resolve();
  EXPECT_DOUBLE_EQ(node.x[1], 0);
  EXPECT_DOUBLE_EQ(node.x[0], 0);
  EXPECT_DOUBLE_EQ(node.v[1], 0);
  EXPECT_DOUBLE_EQ(node.v[0], 1) << "no friction";
  ASSERT_EQ(node.collisions.contacts(), 1);
  EXPECT_DOUBLE_EQ(node.collisions.impulse()[1], 2 * 3);
}

TEST(Collisions, KeepASeparatingVelocity) {
  OneNode node(0.5);
  node.v = {1, 4, 0};
  node.resolve();
  EXPECT_EQ(node.v[1], 4);
  EXPECT_EQ(node.v[0], 1) << "no normal impulse, no friction";
  EXPECT_EQ(node.collisions.constraints().front().prescribed[1], 4);
}

TEST(Collisions, ImpactFrictionIsCoulombs) {
  OneNode node(0.2);
  node.resolve();
  EXPECT_NEAR(node.v[0], 1 - 0.2 * 3, 1e-15);
  OneNode sticking(0.4);
  sticking.resolve();
  EXPECT_NEAR(sticking.v[0], 0, 1e-15) << "never reverses";
}

TEST(Collisions, PositionFrictionFollowsTheDepth) {
  OneNode node(0.2);  // depth 0.01 over 0.1 s: a change of 0.1 m/s, friction 0.02 m/s, over 0.1 s
  node.resolve();
  EXPECT_NEAR(node.x[0], -0.1 * 0.02, 1e-16);
}

TEST(Collisions, FollowAMovingBody) {
  OneNode node(10, {{5, 2, 0}});
  node.x[1] = 0.1;  // the plane stands at 0.2 at the end of the step
  node.resolve();
  EXPECT_DOUBLE_EQ(node.x[1], 0.2);
  EXPECT_DOUBLE_EQ(node.v[1], 2);
  EXPECT_DOUBLE_EQ(node.v[0], 5) << "carried along by the belt";
}

TEST(Collisions, ANodeAtRestSticksUntilItPullsTooHard) {
  OneNode node(0.25);
  node.v = {0, 0, 0};
  node.predicted = {0.3, -0.1, 0};
  node.resolve();
  EXPECT_DOUBLE_EQ(node.x[0], -0.1 * 0.3) << "the position does not creep";
  EXPECT_EQ(node.collisions.constraints().front().free, Mat3d{});
  std::vector<double> within{-0.9, 4, 0}, beyond{-1.1, 4, 0};
  EXPECT_EQ(node.collisions.friction_error(node.v, within).excess, 0);
  EXPECT_EQ(node.collisions.friction_error(node.v, within).allowed, 1);
  node.collisions.slide(node.v, within);
  EXPECT_EQ(node.collisions.constraints().front().free, Mat3d{}) << "within Coulomb's cone";
  EXPECT_NEAR(node.collisions.friction_error(node.v, beyond).excess, 0.1, 1e-15);
  node.collisions.slide(node.v, beyond);
  EXPECT_NEAR(node.collisions.friction()[0], -1, 1e-15) << "0.25 of the normal reaction, as it was held";
  EXPECT_NEAR(beyond[0], -0.1, 1e-15) << "what friction cannot hold is left over";
  EXPECT_EQ(node.collisions.constraints().front().free(0, 0), 1) << "let go";
}

TEST(Collisions, ASlidingNodeIsRubbedWithCoulombsImpulse) {
  OneNode node(0.25);
  node.v = {1, 0, 0};
  node.resolve();
  std::vector<double> pressed{0, 4, 0}, pressed_more{0, 6, 0};
  const std::vector<double> pulled{0, -4, 0};
  EXPECT_EQ(node.collisions.friction_error(node.v, pressed).excess, 1);
  node.collisions.slide(node.v, pressed);
  EXPECT_NEAR(node.collisions.friction()[0], -1, 1e-15);
  EXPECT_NEAR(pressed[0], 1, 1e-15) << "the impulse stands on the other side now";
  EXPECT_EQ(node.collisions.friction_error(node.v, pressed).excess, 0);
  EXPECT_EQ(node.collisions.friction_error(node.v, pressed_more).excess, 0.5);
  EXPECT_EQ(node.collisions.friction_error(node.v, pulled).allowed, 0) << "adhesion rubs nothing";
  node.collisions.slide(node.v, pressed_more);
  EXPECT_NEAR(node.collisions.friction()[0], -1.5, 1e-15);
  EXPECT_NEAR(pressed_more[0], 0.5, 1e-15) << "what has been put there before is not put again";
}

TEST(Collisions, FrictionNeverTurnsANodeRound) {
  OneNode node(0.25);
  node.v = {1, 0, 0};
  node.resolve();
  std::vector<double> pressed{0, 4, 0};
  node.collisions.slide(node.v, pressed);
  node.v = {-0.5, 0, 0.25};
  node.collisions.stop_reversed(node.v);
  EXPECT_EQ(node.v, (std::vector<double>{0, 0, 0}));
  EXPECT_NEAR(node.collisions.friction()[0], -1, 1e-15);
  EXPECT_NEAR(node.collisions.impulse()[0], 2 * 0.5, 1e-15);
}

TEST(Collisions, FixedNodesPassThrough) {
  OneNode node(0.5);
  const std::vector<NodeConstraint> fixed{{0, Mat3d{}, Vec3d{}}};
  node.resolve(fixed);
  EXPECT_EQ(node.collisions.contacts(), 0);
  EXPECT_DOUBLE_EQ(node.x[1], -0.01);
}

TEST(Collisions, InACornerBothNormalsAreHeld) {
  std::vector<std::unique_ptr<Obstacle>> obstacles = OneNode::ground(0, {});
  obstacles.push_back(half_space("wall", 0, {{1, 0, 0}}));
  const std::vector<double> mass{1.0};
  Collisions collisions(std::move(obstacles), mass);
  std::vector<double> x{-0.1, -0.1, 0}, v{-1, -1, 1};
  const auto predicted = v;
  collisions.resolve(x, v, predicted, {}, step);
  EXPECT_EQ(x, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(v, (std::vector<double>{0, 0, 1}));
  ASSERT_EQ(collisions.constraints().size(), 1U);
  const auto p = collisions.constraints().front().free;
  EXPECT_NEAR(norm(p - diagonal(Vec3d{{0, 0, 1}})), 0, 1e-15);
}

}  // namespace
}  // namespace evert
