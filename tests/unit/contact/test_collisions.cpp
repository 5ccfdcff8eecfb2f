#include "evert/contact/collisions.hpp"
#include "evert/math/nodal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>

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

  /// Of impacts, of friction and stops, as if the solve had exerted nothing.
  Vec3d impulse() {
    const std::vector<double> none(3);
    collisions.share_impulses(none, {}, collisions.constraints());
    return collisions.impulse();
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
  EXPECT_DOUBLE_EQ(node.impulse()[1], 2 * 3);
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
  EXPECT_NEAR(node.impulse()[0], -1, 1e-15) << "0.25 of the normal reaction, as it was held";
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
  EXPECT_NEAR(node.impulse()[0], -1, 1e-15);
  EXPECT_NEAR(pressed[0], 1, 1e-15) << "the impulse stands on the other side now";
  EXPECT_EQ(node.collisions.friction_error(node.v, pressed).excess, 0);
  EXPECT_EQ(node.collisions.friction_error(node.v, pressed_more).excess, 0.5);
  EXPECT_EQ(node.collisions.friction_error(node.v, pulled).allowed, 0) << "adhesion rubs nothing";
  node.collisions.slide(node.v, pressed_more);
  EXPECT_NEAR(node.impulse()[0], -1.5, 1e-15);
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
  EXPECT_NEAR(node.impulse()[0], -1 + 2 * 0.5, 1e-15);
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

// --- several bodies, and fast ones

/// A ball of radius 1.
std::unique_ptr<Obstacle> ball(const char* name, double friction, const Vec3d& center,
                               const Vec3d& velocity) {
  return std::make_unique<Obstacle>(
      name, friction, std::make_unique<Sphere>(1),
      std::make_unique<UniformMotion>(RigidState{.origin = center, .velocity = velocity}));
}

/// What becomes of random nodes in the neighbourhood of three moving balls and a floor, in an order.
std::vector<double> after_balls_and_floor(const std::vector<int>& order) {
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  for (const int which : order) {
    if (which == 0) obstacles.push_back(half_space("floor", 0.3, {{0, 1, 0}}));
    if (which == 1) obstacles.push_back(ball("left", 0.5, {-0.8, 0.1, 0}, {1, 0, 0}));
    if (which == 2) obstacles.push_back(ball("right", 0.1, {0.8, 0.2, 0}, {-0.5, 0.2, 0.3}));
    if (which == 3) obstacles.push_back(ball("behind", 0, {0, 0.3, -0.9}, {0, 0, 0.4}));
  }
  constexpr std::size_t nodes = 2000;
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> place(-1.2, 1.2), speed(-2, 2);
  std::vector<double> mass(nodes, 0.5), x(3 * nodes), v(3 * nodes), predicted(3 * nodes);
  for (auto& value : x) value = place(random);
  for (auto& value : v) value = speed(random);
  for (auto& value : predicted) value = speed(random);
  Collisions collisions(std::move(obstacles), mass);
  collisions.resolve(x, v, predicted, {}, step);
  x.insert(x.end(), v.begin(), v.end());
  return x;
}

TEST(Collisions, DoNotDependOnTheOrderOfTheBodies) {
  const auto one = after_balls_and_floor({0, 1, 2, 3});
  for (const auto& order : {std::vector{3, 2, 1, 0}, std::vector{1, 3, 0, 2}}) {
    const auto other = after_balls_and_floor(order);
    double difference = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
      difference = std::max(difference, std::abs(one[i] - other[i]));
    EXPECT_LE(difference, 1e-9);
  }
}

TEST(Collisions, APinchedNodeStopsBetweenTheBodiesAndGoesWithThem) {
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(half_space("left", 0.2, {{1, 0, 0}}, {{1, 2, 0}}));     // solid up to x = 0.1
  obstacles.push_back(half_space("right", 0.2, {{-1, 0, 0}}, {{-1, 4, 0}}));  // and from x = −0.1 on
  const std::vector<double> mass{1.0};
  Collisions collisions(std::move(obstacles), mass);
  std::vector<double> x{0.05, 0, 0}, v{0, 0, 0};
  const auto predicted = v;
  collisions.resolve(x, v, predicted, {}, step);
  EXPECT_NEAR(x[0], 0, 1e-9);
  EXPECT_NEAR(x[1], 0.1 * 3, 1e-12);
  EXPECT_NEAR(v[0], 0, 1e-8);
  EXPECT_NEAR(v[1], 3, 1e-12);
  EXPECT_EQ(collisions.constraints().front().free, Mat3d{});
}

/// Where a node ends that was led into the tip of a wedge, at (0, −0.2), that opens upward by 40 degrees and
/// moves downward at 2 m/s.
std::vector<double> after_a_wedge(double friction) {
  const double angle = 20 * std::numbers::pi / 180, across = std::cos(angle), up = std::sin(angle);
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(half_space("left", friction, {{across, up, 0}}, {{0, -2, 0}}));
  obstacles.push_back(half_space("right", friction, {{-across, up, 0}}, {{0, -2, 0}}));
  const std::vector<double> mass{1.0};
  Collisions collisions(std::move(obstacles), mass);
  std::vector<double> x{0.01, -0.25, 0}, v{0, -1, 0};
  const auto predicted = v;
  collisions.resolve(x, v, predicted, {}, step);
  return x;
}

TEST(Collisions, RoughBodiesThatCloseInAtAnAngleTakeTheNodeAlong) {
  const auto gripped = after_a_wedge(0.4);  // by more than tan(20 degrees)
  EXPECT_NEAR(gripped[0], 0, 1e-9) << "in the middle";
  EXPECT_NEAR(gripped[1], -0.15 - 0.1 * 2, 1e-12) << "with the bodies";
  const auto slipped = after_a_wedge(0.3);
  EXPECT_NEAR(slipped[0], 0, 1e-12);
  EXPECT_NEAR(slipped[1], -0.2, 1e-12) << "out of them";
}

TEST(Collisions, CatchNodesThatAStepTakesThroughABody) {
  for (const double speed : {50.0, 5000.0, 5e7})  // of a ball of radius 1, in steps of 0.1 s
    for (const double share : {0.3, 0.5, 0.9}) {  // of the step, until the node is in the middle
      std::vector<std::unique_ptr<Obstacle>> obstacles;
      obstacles.push_back(ball("ball", 0, {}, {}));
      const std::vector<double> mass{1.0};
      Collisions collisions(std::move(obstacles), mass);
      const double begin = std::max(share * speed * 0.1, 1.2);
      std::vector<double> x{0, begin - 0.1 * speed, 0.1}, v{0, -speed, 0};
      const auto predicted = v;
      ASSERT_LT(x[1], 0) << "it must go through";
      collisions.resolve(x, v, predicted, {}, step);
      ASSERT_EQ(collisions.contacts(), 1) << speed << ' ' << share;
      EXPECT_NEAR(x[1], std::sqrt(1 - 0.01), 1e-6) << "where it came in";
      EXPECT_NEAR(x[2], 0.1, 1e-6);
      EXPECT_GE(v[1], -0.11 * speed) << "only along the surface";
    }
}

TEST(Collisions, CatchNodesThatABodyJumpsOver) {
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(ball("ball", 0, {0, -60 + 0.1 * 600, 0}, {0, 600, 0}));  // from y = 0 to y = 60
  const std::vector<double> mass{1.0};
  Collisions collisions(std::move(obstacles), mass);
  std::vector<double> x{0, 7, 0}, v{0, 0, 0};
  const auto predicted = v;
  collisions.resolve(x, v, predicted, {}, step);
  ASSERT_EQ(collisions.contacts(), 1);
  EXPECT_NEAR(x[1], 61, 1e-9) << "in front of it";
  EXPECT_NEAR(v[1], 600, 1e-9);
}

TEST(Collisions, WarnOnceOfABodyThatTurnsFast) {
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(std::make_unique<Obstacle>(
      "mixer", 0, std::make_unique<Sphere>(1),
      std::make_unique<UniformMotion>(RigidState{.angular_velocity = {0, 0, 10}})));
  const std::vector<double> mass{1.0};
  Collisions collisions(std::move(obstacles), mass);
  std::vector<double> x{0, 7, 0}, v{0, 0, 0};
  const auto predicted = v;
  collisions.resolve(x, v, predicted, {}, step);
  collisions.resolve(x, v, predicted, {}, step);
  const auto notes = collisions.take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes.front().find("'mixer' turns by 57 degrees"), std::string::npos) << notes.front();
}

TEST(Collisions, GiveEveryBodyItsShareOfTheImpulse) {
  std::vector<std::unique_ptr<Obstacle>> obstacles = OneNode::ground(0.5, {});
  obstacles.push_back(half_space("wall", 0, {{1, 0, 0}}));
  obstacles.push_back(ball("far", 0.5, {50, 0, 0}, {}));
  const std::vector<double> mass{2.0};
  Collisions collisions(std::move(obstacles), mass);
  std::vector<double> x{-0.1, -0.1, 3}, v{-1, -3, 5};
  const auto predicted = v;
  collisions.resolve(x, v, predicted, {}, step);
  const auto& ground = collisions.impulse_of(0);
  EXPECT_LE(norm(ground.linear - Vec3d{0, 2 * 3, -2 * 0.5 * 3}), 1e-14) << "with all of the friction";
  EXPECT_LE(norm(ground.angular - cross(Vec3d{x[0], x[1], x[2]}, ground.linear)), 1e-14);
  EXPECT_LE(norm(collisions.impulse_of(1).linear - Vec3d{2, 0, 0}), 1e-14);
  EXPECT_EQ(collisions.impulse_of(2).linear, Vec3d{});
  EXPECT_LE(norm(collisions.impulse() - 2 * (Vec3d{v[0], v[1], v[2]} - Vec3d{-1, -3, 5})), 1e-14);
}

}  // namespace
}  // namespace evert
