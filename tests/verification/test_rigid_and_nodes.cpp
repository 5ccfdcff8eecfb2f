// Rigid bodies with a mass and deformable bodies that hit each other.
#include <gtest/gtest.h>

#include "tests/support/petsc_options.hpp"
#include "tests/support/ranks.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <cmath>

namespace evert {
namespace {

/// A cube in the air that a spinning ball hits off its middle, without gravity.
std::string hit_cube(const std::string& ball_mass) {
  return R"(
name: hit
end_time: 1
bodies:
  cube:
    mesh: {generate: box, size: [0.4, 0.4, 0.4], cells: [3, 3, 3], cell: tet6}
    density: 500
    velocity: [1, 0, 0]
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
    damping: {model: objective, stiffness_proportional: 2.0e-3}
obstacles:
  ball: {shape: sphere, center: [-0.4, 0.05, 0.03], radius: 0.15, friction: 0.5, initial_velocity: [4, 0, 0],
         initial_angular_velocity: [0, 6, 9], mass: )" +
         ball_mass + "}\n";
}

TEST(RigidAndNodes, KeepTheirMomentumTogether) {
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-13"}};
  for (const std::string mass : {"0.2", "20"}) {  // a 160th of the cube, and most of it
    auto scene = test::build(hit_cube(mass));
    auto& simulation = *scene.simulation;
    const auto start = simulation.measure();
    const double highest = start.kinetic_energy;
    for (int step = 0; step < 300; ++step) simulation.step(1e-3);
    const auto now = simulation.measure();
    const auto given = simulation.obstacle_impulses().front().linear;
    const double lost = norm(now.momentum - start.momentum) / norm(start.momentum);
    test::verify("ball of " + mass + " kg hits a cube: change of the momentum of both over what it was", "0",
                 lost, "<= 1e-10");
    EXPECT_LE(lost, 1e-10);
    EXPECT_GT(norm(given), 0.1) << "they must have met";
    EXPECT_LE(norm(now.contact_impulse), 0) << "nothing else was touched";
    EXPECT_LE(now.kinetic_energy + now.elastic_energy, highest * (1 + 1e-9));
    // Moving nodes out of the ball in their places, not in their velocities, is no impulse but a small
    // torque.
    const double turned = norm(now.angular_momentum - start.angular_momentum) / norm(start.angular_momentum);
    test::verify("ball of " + mass + " kg hits a cube: change of the angular momentum of both", "0", turned,
                 "<= 0.02");
    EXPECT_LE(turned, 0.02);
  }
}

TEST(RigidAndNodes, KeepTheirMomentumTogetherWithExplicitDamping) {
  for (const std::string mass : {"0.2", "20"}) {
    auto scene = test::build(hit_cube(mass), {"integrator.method=verlet"});
    auto& simulation = *scene.simulation;
    const auto start = simulation.measure();
    for (int step = 0; step < 600; ++step) simulation.step(5e-4);
    const auto now = simulation.measure();
    const double lost = norm(now.momentum - start.momentum) / norm(start.momentum);
    test::verify("ball of " + mass + " kg hits a cube, verlet: change of the momentum of both", "0", lost,
                 "<= 1e-10");
    EXPECT_LE(lost, 1e-10);
    EXPECT_GT(norm(simulation.obstacle_impulses().front().linear), 0.1) << "they must have met";
    EXPECT_LE(norm(now.contact_impulse), 0) << "nothing else was touched";
    EXPECT_LE(now.kinetic_energy + now.elastic_energy, start.kinetic_energy * (1 + 1e-3));
  }
}

/// A ball of this mass on a mattress, damped so stiffly that its surface weighs more than the ball.
/// Off the axis of the mattress: on it, the direction in which the node below slides would be rounding.
std::string ball_on_mattress(const std::string& mass) {
  return R"(
name: rest
end_time: 4
gravity: [0, -9.81, 0]
bodies:
  mattress:
    mesh: {generate: box, min: [-0.4, 0, -0.4], max: [0.4, 0.2, 0.4], cells: [4, 1, 4], cell: tet6}
    density: 100
    material: {model: neo_hookean, youngs_modulus: 2.0e4, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 2.0e-2}
constraints:
  - {body: mattress, node_set: y_min, fixed: true}
obstacles:
  ball: {shape: sphere, center: [0.03, 0.41, 0.017], radius: 0.2, friction: 0.4, mass: )" +
         mass + "}\n";
}

TEST(RigidAndNodes, ABallComesToRestOnAMattressHoweverLight) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  for (const std::string mass : {"0.01", "3"}) {
    auto scene = test::build(ball_on_mattress(mass));
    auto& simulation = *scene.simulation;
    const auto before = simulation.measure();
    while (simulation.time() < 3) simulation.step(std::min(4e-3, simulation.suggested_time_step()));
    const auto* ball = simulation.obstacles().front()->body();
    const auto begin = simulation.obstacle_impulses().front().linear;
    const double time = simulation.time();
    while (simulation.time() < 4) simulation.step(std::min(4e-3, simulation.suggested_time_step()));
    const auto given = simulation.obstacle_impulses().front().linear - begin;
    const double weight = std::stod(mass) * 9.81;
    test::verify("ball of " + mass + " kg on a mattress: its force over its weight", "1",
                 -given[1] / (simulation.time() - time) / weight, "0.99 to 1.01");
    EXPECT_NEAR(-given[1] / (simulation.time() - time) / weight, 1, 0.01) << mass;
    // A ball that is light beside the nodes may touch them in every other step: half of g Δt either way.
    EXPECT_LE(norm(ball->velocity()), 9.81 * 4e-3) << mass;
    const auto now = simulation.measure();
    EXPECT_LE(now.total_energy(), before.total_energy());
  }
}

TEST(RigidAndNodes, AgreeOnAnyNumberOfRanks) {
  const auto yaml = ball_on_mattress("3");
  const auto alone = test::build(yaml, {}, PETSC_COMM_SELF);
  const auto together = test::build(yaml);
  const auto x_alone = test::after_steps(*alone.simulation, 200);
  const auto x_together = test::after_steps(*together.simulation, 200);
  EXPECT_LE(test::largest_difference(x_alone, x_together), 1e-9);
  const auto center = [](const BuiltScene& scene) {
    return scene.simulation->obstacles().front()->body()->center();
  };
  EXPECT_LE(norm(center(alone) - center(together)), 1e-9);
  EXPECT_GT(norm(together.simulation->obstacle_impulses().front().linear), 0) << "they must have met";
}

TEST(RigidAndNodes, ARestoredRunIsBitwiseEqual) {
  const auto yaml = hit_cube("20");
  auto whole = test::build(yaml);
  test::after_steps(*whole.simulation, 60);
  EXPECT_GT(norm(whole.simulation->obstacle_impulses().front().linear), 0) << "in the middle of the impact";
  const test::KeptState kept(*whole.simulation);
  const auto uninterrupted = test::after_steps(*whole.simulation, 100);

  auto restarted = test::build(yaml);
  kept.restore(*restarted.simulation);
  EXPECT_EQ(test::after_steps(*restarted.simulation, 100), uninterrupted);
  EXPECT_EQ(restarted.simulation->obstacles().front()->body()->save(),
            whole.simulation->obstacles().front()->body()->save());
}

/// A block of rubber on a plane that moves like a belt, or turns like a disk.
std::string block_on(const std::string& motion) {
  return R"(
name: carried
end_time: 2
gravity: [0, -9.81, 0]
bodies:
  block:
    mesh: {generate: box, min: [0.4, 0, -0.1], max: [0.6, 0.05, 0.1], cells: [4, 1, 4], cell: tet6}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 2.0e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 2.0e-3}
obstacles:
  belt: {shape: half_space, normal: [0, 1, 0], friction: 0.3, motion: {)" +
         motion + "}}\n";
}

TEST(MovingObstacles, ABlockIsCarriedByABelt) {
  constexpr double speed = 1.5, mass = 2, pull = 0.3 * 9.81;
  auto scene = test::build(block_on("velocity: [1.5, 0, 0]"));
  auto& simulation = *scene.simulation;
  test::run_until(simulation, 0.2);
  const double first = simulation.measure().momentum[0] / mass;
  test::run_until(simulation, 0.4);
  const double second = simulation.measure().momentum[0] / mass;
  test::verify("block carried by a belt: acceleration over mu g", "1", (second - first) / 0.2 / pull,
               "0.99 to 1.01");
  EXPECT_NEAR((second - first) / 0.2 / pull, 1, 0.01);
  test::run_until(simulation, 1);
  const double carried = simulation.measure().momentum[0] / mass;
  test::verify("block carried by a belt: its velocity over that of the belt in the end", "1", carried / speed,
               "0.999 to 1.001");
  EXPECT_NEAR(carried / speed, 1, 1e-3);
}

TEST(MovingObstacles, ABlockIsPulledByABeltWhateverTheMethod) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  constexpr double mass = 2, pull = 0.3 * 9.81;
  for (const char* method : {"verlet", "symplectic_euler"}) {
    auto scene = test::build(
        block_on("velocity: [1.5, 0, 0]"),
        {std::string("integrator.method=") + method, "bodies.block.damping.stiffness_proportional=2e-4"});
    auto& simulation = *scene.simulation;
    test::run_until(simulation, 0.2);
    const double first = simulation.measure().momentum[0] / mass;
    test::run_until(simulation, 0.4);
    const double second = simulation.measure().momentum[0] / mass;
    test::verify(std::string("block carried by a belt, ") + method + ": acceleration over mu g", "1",
                 (second - first) / 0.2 / pull, "0.99 to 1.01");
    EXPECT_NEAR((second - first) / 0.2 / pull, 1, 0.01) << method;
    const auto given = simulation.obstacle_impulses().front().linear - simulation.measure().contact_impulse;
    EXPECT_LE(norm(given), 1e-12) << "the only obstacle gave it all";
  }
}

TEST(MovingObstacles, ABlockGoesRoundOnATurningDisk) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  constexpr double spin = 1.5, radius = 0.5;  // ω² r = 1.1 m/s², less than friction may give
  auto scene = test::build(block_on("angular_velocity: [0, 1.5, 0], about: [0, 0, 0]"),
                           {"bodies.block.velocity=[0, 0, -0.75]", "bodies.block.spin=[0, 1.5, 0]"});
  auto& simulation = *scene.simulation;
  const auto angle = [&] {
    const auto x = test::gathered(simulation.mesh(), simulation.positions());
    Vec3d sum{};
    for (std::size_t i = 0; i < x.size(); ++i) sum[i % 3] += x[i];
    const double count = static_cast<double>(x.size()) / 3;
    EXPECT_NEAR(std::hypot(sum[0], sum[2]) / count, radius, 0.01 * radius) << "it must not slide out";
    return std::atan2(-sum[2], sum[0]);
  };
  test::run_until(simulation, 0.2);
  const double before = angle();
  test::run_until(simulation, 1.2);
  const double turned = angle() - before;
  test::verify("block on a turning disk: its angle over that of the disk", "1", turned / spin,
               "0.999 to 1.001");
  EXPECT_NEAR(turned / spin, 1, 1e-3);
}

}  // namespace
}  // namespace evert
