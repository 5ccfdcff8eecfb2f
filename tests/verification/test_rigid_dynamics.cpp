// Rigid bodies alone and against obstacles, against closed forms.
#include "evert/contact/rigid_dynamics.hpp"
#include "evert/shapes/solids.hpp"

#include <gtest/gtest.h>

#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

constexpr double g = 9.81;

/// A world of obstacles.
class World {
 public:
  template <class Shape>
  std::size_t body(Shape shape, double density, const RigidState& start, double friction) {
    auto body = std::make_unique<RigidBody>(mass_of(shape).times(density), start);
    return add(std::make_unique<Obstacle>("body", friction, std::make_unique<Shape>(shape), std::move(body)));
  }
  std::size_t plane(const Vec3d& point, const Vec3d& normal, double friction, const RigidState& motion = {}) {
    return add(std::make_unique<Obstacle>("plane", friction, std::make_unique<HalfSpace>(point, normal),
                                          std::make_unique<UniformMotion>(motion)));
  }
  std::size_t ball(double radius, const Vec3d& center) {
    return add(std::make_unique<Obstacle>("ball", 0.5, std::make_unique<Sphere>(radius),
                                          std::make_unique<UniformMotion>(RigidState{.origin = center})));
  }
  /// Runs to `end`, calling look() after every step.
  template <class Look>
  void run(double end, double dt, const Vec3d& gravity, Look&& look) {
    RigidDynamics dynamics(obstacles_);
    const auto steps = std::lround(end / dt);
    for (long i = 1; i <= steps; ++i) {
      dynamics.advance({static_cast<double>(i) * dt, dt}, gravity);
      look(dynamics);
    }
  }
  void run(double end, double dt, const Vec3d& gravity) {
    run(end, dt, gravity, [](const RigidDynamics&) {});
  }
  /// From a state that a run had at `begin`.
  void run_restored(const std::vector<std::pair<std::string, double>>& kept, double begin, double end,
                    double dt, const Vec3d& gravity) {
    RigidDynamics dynamics(obstacles_);
    dynamics.restore(kept, begin);
    for (long i = std::lround(begin / dt) + 1; i <= std::lround(end / dt); ++i)
      dynamics.advance({static_cast<double>(i) * dt, dt}, gravity);
  }
  [[nodiscard]] const RigidBody& operator[](std::size_t number) const { return *obstacles_[number]->body(); }

 private:
  std::size_t add(std::unique_ptr<Obstacle> obstacle) {
    obstacles_.push_back(std::move(obstacle));
    return obstacles_.size() - 1;
  }
  std::vector<std::unique_ptr<Obstacle>> obstacles_;
};

TEST(RigidBody, FallsAlongAParabolaExactly) {
  World world;
  const auto ball = world.body(Sphere(0.1), 1000, {.origin = {1, 2, 3}, .velocity = {1, 4, 0}}, 0);
  world.run(0.7, 0.01, {0, -g, 0});
  EXPECT_LE(norm(world[ball].center() - Vec3d{1.7, 2 + 2.8 - g * 0.245, 3}), 1e-13);
}

/// After one second of the motion of a box that tumbles about its middle axis.
std::pair<Mat3d, double> tumbled(double dt) {
  World world;
  const auto box = world.body(Box({1, 0.6, 0.2}), 500, {.angular_velocity = {0.01, 5, 0.02}}, 0);
  const auto momentum = world[box].angular_momentum();
  const double energy = world[box].kinetic_energy();
  double drift = 0;
  world.run(2, dt, {}, [&](const RigidDynamics&) {
    EXPECT_EQ(world[box].angular_momentum(), momentum);
    drift = std::max(drift, std::abs(world[box].kinetic_energy() / energy - 1));
  });
  return {world[box].at(2).rotation, drift};
}

TEST(RigidBody, TumblesWithItsAngularMomentumAndToSecondOrder) {
  const auto exact = tumbled(1e-4).first;
  const auto [coarse, drift] = tumbled(8e-3);
  const auto fine = tumbled(4e-3).first;
  const double order = std::log2(norm(coarse - exact) / norm(fine - exact));
  test::verify("tumbling box: order of the rotation in the time step", "2", order, ">= 1.9");
  test::verify("tumbling box: largest relative change of energy, steps of 8 ms", "0", drift, "<= 1e-3");
  EXPECT_GE(order, 1.9);
  EXPECT_LE(drift, 1e-3);
}

TEST(RigidContacts, ABallRollsDownASlopeAtFiveSeventhsOfItsPull) {
  const double angle = 0.4, radius = 0.1, end = 1;
  World world;
  const auto ball = world.body(Sphere(radius), 1000, {.origin = {0, radius, 0}}, 0.5);
  world.plane({}, {0, 1, 0}, 0.5);
  world.run(end, 1e-3, {g * std::sin(angle), -g * std::cos(angle), 0});
  const double expected = 5.0 / 7 * g * std::sin(angle);
  test::verify("rolling ball: acceleration over 5/7 g sin(angle)", "1",
               world[ball].velocity()[0] / end / expected, "1 +- 1e-6");
  EXPECT_NEAR(world[ball].velocity()[0] / end, expected, 1e-6 * expected);
  EXPECT_NEAR(world[ball].angular_velocity()[2], -world[ball].velocity()[0] / radius, 1e-9);
  EXPECT_NEAR(world[ball].center()[0], expected * end * end / 2, 0.01 * expected);
  EXPECT_NEAR(world[ball].center()[1], radius, 1e-12);
}

TEST(RigidContacts, ABallSlidesWhereTheSlopeIsTooSteepToRoll) {
  const double angle = 1.0, friction = 0.2, end = 0.5;  // rolling takes 2/7 tan(1) = 0.44
  World world;
  const auto ball = world.body(Sphere(0.1), 1000, {.origin = {0, 0.1, 0}}, friction);
  world.plane({}, {0, 1, 0}, friction);
  world.run(end, 1e-3, {g * std::sin(angle), -g * std::cos(angle), 0});
  const double expected = g * (std::sin(angle) - friction * std::cos(angle));
  EXPECT_NEAR(world[ball].velocity()[0] / end / expected, 1, 1e-6);
  EXPECT_NEAR(world[ball].angular_velocity()[2] / end, -2.5 * friction * g * std::cos(angle) / 0.1, 1e-3);
}

TEST(RigidContacts, ABallSettlesBetweenTwoPlanes) {
  const double radius = 0.2, slant = std::sqrt(0.5), dt = 1e-3;
  World world;
  const auto ball = world.body(Sphere(radius), 1000, {.origin = {0.3, 1, 0}, .velocity = {0.5, 0, 0}}, 0.3);
  const auto left = world.plane({}, {slant, slant, 0}, 0.3);
  const auto right = world.plane({}, {-slant, slant, 0}, 0.3);
  Vec3d from_left{}, from_right{};
  world.run(5, dt, {0, -g, 0}, [&](const RigidDynamics& dynamics) {
    from_left = (1 / dt) * dynamics.impulse_of(left).first;
    from_right = (1 / dt) * dynamics.impulse_of(right).first;
  });
  const double weight = world[ball].mass().mass * g;
  test::verify("ball between two planes: height of its centre over radius sqrt(2)", "1",
               world[ball].center()[1] / (radius / slant), "1 +- 1e-4");
  test::verify("ball between two planes: force of both over its weight", "1",
               (from_left + from_right)[1] / weight, "1 +- 1e-6");
  EXPECT_NEAR(world[ball].center()[1], radius / slant, 1e-4 * radius / slant);
  EXPECT_NEAR(world[ball].center()[0], 0, 1e-4);
  EXPECT_LE(norm(world[ball].velocity()), 1e-9);
  EXPECT_LE(norm(from_left + from_right - Vec3d{0, weight, 0}), 1e-6 * weight);
}

TEST(RigidContacts, ABlockIsCarriedByABelt) {
  const double friction = 0.3, speed = 1.5, end = 1;
  World world;
  const auto block = world.body(Box({0.4, 0.1, 0.2}), 800, {.origin = {0, 0.05, 0}}, friction);
  world.plane({}, {0, 1, 0}, friction, {.velocity = {speed, 0, 0}});
  double slipped = 0;
  world.run(end, 1e-3, {0, -g, 0}, [&](const RigidDynamics&) {
    if (world[block].velocity()[0] < speed * (1 - 1e-9)) slipped += 1e-3;
  });
  const double until = speed / (friction * g);
  test::verify("block on a belt: time of slip over v / (mu g)", "1", slipped / until, "0.99 to 1.01");
  test::verify("block on a belt: way over that of Coulomb", "1",
               world[block].center()[0] / (speed * (end - until / 2)), "0.99 to 1.01");
  EXPECT_NEAR(slipped, until, 0.01 * until);
  EXPECT_NEAR(world[block].center()[0], speed * (end - until / 2), 0.01 * speed);
  EXPECT_LE(norm(world[block].velocity() - Vec3d{speed, 0, 0}), 1e-9);
}

TEST(RigidContacts, ABlockSpinsDownOnItsCorners) {
  const double friction = 0.25, spin = 8, width = 0.4;
  World world;
  const auto block = world.body(Box({width, 0.1, width}), 800,
                                {.origin = {0, 0.05, 0}, .angular_velocity = {0, spin, 0}}, friction);
  world.plane({}, {0, 1, 0}, friction);
  double turning = 0;
  world.run(1.5, 5e-4, {0, -g, 0}, [&](const RigidDynamics&) {
    if (norm(world[block].angular_velocity()) > 1e-9) turning += 5e-4;
  });
  const auto& mass = world[block].mass();
  const double expected = spin * mass.inertia(1, 1) / (friction * mass.mass * g * width * std::sqrt(0.5));
  test::verify("block that spins down on its corners: time over that of Coulomb", "1", turning / expected,
               "0.99 to 1.01");
  EXPECT_NEAR(turning, expected, 0.01 * expected);
  EXPECT_LE(norm(world[block].center() - Vec3d{0, 0.05, 0}), 2e-3);
}

TEST(RigidContacts, ABlockBelowTheCoulombAngleStaysForTenSeconds) {
  const double angle = std::atan(0.3) * 0.95;
  World world;
  const auto block = world.body(Box({0.4, 0.1, 0.2}), 800, {.origin = {0, 0.05, 0}}, 0.3);
  world.plane({}, {0, 1, 0}, 0.3);
  world.run(10, 2e-3, {g * std::sin(angle), -g * std::cos(angle), 0});
  const double crept = norm(world[block].center() - Vec3d{0, 0.05, 0});
  test::verify("rigid block at 95 % of the Coulomb angle: creep in 10 s [m]", "0", crept, "<= 1e-9");
  EXPECT_LE(crept, 1e-9);
}

TEST(RigidContacts, ATumblingBoxNeverGainsEnergy) {
  for (const double friction : {0.0, 0.4}) {
    World world;
    const auto box = world.body(Box({0.5, 0.3, 0.2}), 800,
                                {rotation_by({0.4, 0.2, 0.7}), {0, 1, 0}, {2, 0, 0.5}, {3, -2, 5}}, friction);
    world.plane({}, {0, 1, 0}, friction);
    world.ball(0.3, {1.2, 0, 0.2});
    const double weight = world[box].mass().mass * g;
    const auto energy = [&] { return world[box].kinetic_energy() + weight * world[box].center()[1]; };
    const double start = energy();
    double lowest = start, gained = 0;
    world.run(5, 1e-3, {0, -g, 0}, [&](const RigidDynamics&) {
      gained = std::max(gained, energy() - lowest);
      lowest = std::min(lowest, energy());
    });
    test::verify("tumbling box, friction " + std::to_string(friction).substr(0, 3) +
                     ": energy gained at any time over that at the start",
                 "0", gained / start, "<= 1e-3");
    EXPECT_LE(gained, 1e-3 * start);
    if (friction > 0) {
      EXPECT_LE(norm(world[box].velocity()), 1e-6) << "it comes to rest";
    }
  }
}

TEST(RigidContacts, BodiesThatCollideKeepTheirMomenta) {
  World world;
  const auto ball = world.body(Sphere(0.2), 1000, {.origin = {-1, 0.05, 0.02}, .velocity = {3, 0, 0}}, 0.4);
  const auto box = world.body(Box({0.4, 0.6, 0.5}), 300, {.angular_velocity = {0, 1, 0.5}}, 0.4);
  const auto total = [&] {
    Vec3d linear{}, angular{};
    for (const auto number : {ball, box}) {
      const auto& body = world[number];
      const auto momentum = body.mass().mass * body.velocity();
      linear += momentum;
      angular += cross(body.center(), momentum) + body.angular_momentum();
    }
    return std::pair(linear, angular);
  };
  const auto before = total();
  world.run(1, 1e-3, {});
  const auto after = total();
  EXPECT_GT(world[box].velocity()[0], 0.5) << "they must have met";
  EXPECT_LE(norm(after.first - before.first), 1e-12 * norm(before.first));
  EXPECT_LE(norm(after.second - before.second), 1e-3 * norm(before.first)) << "places are pushed apart";
}

TEST(RigidDynamics, GoesOnBitByBitFromItsState) {
  const auto make = [](World& world) {
    world.plane({}, {0, 1, 0}, 0.4);
    return world.body(Box({0.5, 0.3, 0.2}), 800, {.origin = {0, 0.4, 0}, .angular_velocity = {3, -2, 5}},
                      0.4);
  };
  World whole, halves;
  const auto box = make(whole);
  make(halves);
  std::vector<std::pair<std::string, double>> kept;
  int step = 0;
  whole.run(1, 1e-3, {0, -g, 0}, [&](const RigidDynamics& dynamics) {
    if (++step == 500) kept = dynamics.state();
  });
  halves.run_restored(kept, 0.5, 1, 1e-3, {0, -g, 0});
  EXPECT_EQ(whole[box].save(), halves[box].save());
}

}  // namespace
}  // namespace evert
