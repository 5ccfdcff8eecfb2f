// Several obstacles at once: order, ranks, momentum, energy, rest.
#include "evert/core/collective.hpp"

#include <gtest/gtest.h>

#include "tests/support/ranks.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

/// A ball between two balls that turn and come nearer, on a floor that moves sideways; some of its nodes are
/// in two or three of them at once.
std::string squeezed_ball(const std::vector<std::string>& order) {
  std::string scene = R"(
name: squeezed ball
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  ball:
    mesh: {generate: ball, radius: 0.2, edge_length: 0.08}
    transform: {translate: [0, 0.22, 0]}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 5.0e4, poissons_ratio: 0.4}
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
integrator: {time_step: 5e-4}
obstacles:
)";
  for (const auto& name : order) {
    if (name == "floor")
      scene += "  floor: {shape: half_space, normal: [0, 1, 0], friction: 0.4, velocity: [0.2, 0, 0]}\n";
    if (name == "left")
      scene +=
          "  left: {shape: sphere, center: [-0.45, 0.2, 0], radius: 0.3, friction: 0.8, velocity: [1.5, 0, "
          "0.1]}\n";
    if (name == "right")
      scene +=
          "  right: {shape: sphere, center: [0.45, 0.25, 0], radius: 0.3, friction: 0.2, velocity: [-1.5, 0, "
          "0]}\n";
  }
  return scene;
}

TEST(Obstacles, NeitherOrderNorRanksMatter) {
  constexpr double size = 0.4;
  auto scene = test::build(squeezed_ball({"floor", "left", "right"}));
  const auto one = test::after_steps(*scene.simulation, 200);
  EXPECT_GT(scene.simulation->inverted_points(), 0) << "the balls must squeeze";
  const auto other =
      test::after_steps(*test::build(squeezed_ball({"right", "floor", "left"})).simulation, 200);
  const auto alone = test::after_steps(
      *test::build(squeezed_ball({"left", "right", "floor"}), {}, PETSC_COMM_SELF).simulation, 200);
  const double by_order = test::largest_difference(one, other) / size;
  const double by_ranks = test::largest_difference(one, alone) / size;
  test::verify("obstacles: positions after 200 steps in another order, over the size", "0", by_order,
               "<= 1e-9");
  EXPECT_LE(by_order, 1e-9);
  EXPECT_LE(by_ranks, 1e-9);
}

/// Up to what the solves leave over: with the tolerance that scenes have unless they say otherwise it is
/// eight times as much as the bound here.
TEST(Obstacles, ReportWhatTheBodyGets) {
  auto scene = test::build(squeezed_ball({"floor", "left", "right"}));
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure();
  double largest_momentum = 0;
  for (int step = 0; step < 200; ++step) {
    simulation.step(5e-4);
    largest_momentum = std::max(largest_momentum, norm(simulation.measure().contact_impulse));
  }
  const auto now = simulation.measure();
  const auto unbalanced = now.momentum - start.momentum - now.gravity_impulse - now.contact_impulse;
  const double relative = norm(unbalanced) / largest_momentum;
  test::verify("obstacles: momentum of the body less impulses, over the largest", "0", relative, "<= 1e-10");
  EXPECT_LE(relative, 1e-10);
}

/// A ball thrown into a pen of smooth, resting obstacles: no step gains energy but for what the explicit
/// scheme's own energy swings by.
TEST(Obstacles, AtRestAndSmoothGiveNoEnergy) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  auto scene = test::build(R"(
name: pen
end_time: 2
bodies:
  ball:
    mesh: {generate: ball, radius: 0.2, edge_length: 0.1}
    density: 1000
    velocity: [2, -1, 0.5]
    material: {model: neo_hookean, youngs_modulus: 2.0e5, poissons_ratio: 0.3}
    damping: {model: objective, stiffness_proportional: 1.0e-4}
integrator: {time_step: 2e-4}
obstacles:
  left: {shape: half_space, normal: [1, 0, 0], point: [-0.3, 0, 0], friction: 0}
  right: {shape: half_space, normal: [-1, 0.1, 0], point: [0.3, 0, 0], friction: 0}
  below: {shape: sphere, center: [0, -0.6, 0], radius: 0.35, friction: 0}
  above: {shape: half_space, normal: [0, -1, 0.2], point: [0, 0.3, 0], friction: 0}
  behind: {shape: half_space, normal: [0, 0, 1], point: [0, 0, -0.3], friction: 0}
  before: {shape: half_space, normal: [0, 0, -1], point: [0, 0, 0.3], friction: 0}
)");
  auto& simulation = *scene.simulation;
  const auto energy = [&] { return simulation.measure().total_energy(); };
  const double start = energy();
  double lowest = start, gained = 0;
  while (simulation.time() < 2 - 1e-9) {
    simulation.step(2e-4);
    gained = std::max(gained, energy() - lowest);
    lowest = std::min(lowest, energy());
  }
  test::verify("obstacles: energy gained from smooth ones at rest, over that at first", "0", gained / start,
               "<= 1e-3");
  EXPECT_LE(gained, 1e-3 * start);
  EXPECT_LT(lowest, 0.7 * start) << "it must hit them";
}

/// Nodes at the edge of sticking slip to and fro by some micrometres (docs/design/friction.md), the body as a
/// whole stays where it is. On one rank: 30,000 tiny steps are all messages on more.
TEST(Obstacles, ABodyAtRestStaysAtRestForAMinute) {
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "one rank is enough";
  auto scene = test::build(R"(
name: minute
end_time: 90
gravity: [1, -9.81, 0.5]
bodies:
  block:
    mesh: {generate: box, min: [-0.1, 0, -0.1], max: [0.1, 0.1, 0.1], cells: [2, 1, 2], cell: tet6}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 5.0e-3}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.5}
)");
  auto& simulation = *scene.simulation;
  const auto run_to = [&](double end) {
    while (simulation.time() < end - 1e-9)
      simulation.step_to(std::min(end, simulation.time() + simulation.suggested_time_step()));
    return test::gathered(simulation.mesh(), simulation.positions());
  };
  const auto energy = [&] { return simulation.measure().total_energy(); };
  constexpr double size = 0.2;
  run_to(20);
  const auto settled = run_to(25);  // in steps as long as those that follow
  const auto at_first = simulation.measure();
  const double before = energy();
  double drift = 0, gain = 0;
  std::vector<double> now;
  for (double end = 30; end <= 85; end += 5) {
    now = run_to(end);
    drift = std::max(drift, test::largest_difference(settled, now) / size);
    gain = std::max(gain, energy() - before);
  }
  Vec3d mean{};
  for (std::size_t i = 0; i < now.size(); ++i) mean[i % 3] += 3 * (now[i] - settled[i]) / now.size();
  const double relative_gain = gain / std::abs(at_first.gravitational_energy);
  test::verify("obstacles: drift of a block at rest in 60 s, over its size", "0", norm(mean) / size,
               "<= 1e-10");
  test::verify("obstacles: that of its farthest node", "0", drift, "<= 1e-10");
  test::verify("obstacles: energy it gains meanwhile, over that of its weight", "0", relative_gain,
               "<= 1e-12");
  EXPECT_LE(norm(mean) / size, 1e-10);
  EXPECT_LE(drift, 1e-10);
  EXPECT_LE(relative_gain, 1e-12);
}

}  // namespace
}  // namespace evert
