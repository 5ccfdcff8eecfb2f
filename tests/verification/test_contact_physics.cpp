// Friction and bounces against closed forms.
#include <gtest/gtest.h>

#include "tests/support/ranks.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <cmath>
#include <numbers>

namespace evert {
namespace {

/// A stiff block on a plane tilted by `angle` [rad]: gravity is tilted instead of the plane. `damping_time`
/// [s] is stiffness-proportional.
BuiltScene block_on_slope(double angle, double friction, double damping_time) {
  const double g = 9.81;
  const std::string yaml = R"(
name: slope
end_time: 1
gravity: [)" + std::to_string(g * std::sin(angle)) +
                           ", " + std::to_string(-g * std::cos(angle)) +
                           R"(, 0]
bodies:
  block:
    mesh: {generate: box, min: [-0.1, 0, -0.1], max: [0.1, 0.05, 0.1], cells: [4, 1, 4], cell: tet6}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: )" +
                           std::to_string(damping_time) + R"(}
obstacles:
  plane: {shape: half_space, normal: [0, 1, 0], friction: )" +
                           std::to_string(friction) + "}\n";
  return test::build(yaml);
}

double mean_velocity_along_slope(const Simulation& simulation) {
  const auto now = simulation.measure();
  return now.momentum[0] / (1000 * 0.2 * 0.05 * 0.2);
}

TEST(Friction, SlidesWithCoulombsAcceleration) {
  const double friction = 0.3;
  for (const double degrees : {20.0, 30.0, 45.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    auto scene = block_on_slope(angle, friction, 5e-3);
    auto& simulation = *scene.simulation;
    const double begin = test::run_until(simulation, 0.3);
    const double before = mean_velocity_along_slope(simulation);
    const double end = test::run_until(simulation, 0.8);
    const double acceleration = (mean_velocity_along_slope(simulation) - before) / (end - begin);
    const double expected = 9.81 * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_NEAR(acceleration / expected, 1, 0.01) << degrees << " degrees";
    test::verify("friction: acceleration on a slope of " + std::to_string(std::lround(degrees)) +
                     " degrees over Coulomb's",
                 "1", acceleration / expected, "0.99 to 1.01");
  }
}

TEST(Friction, SticksBelowTheCoulombAngle) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  const double friction = 0.3;
  for (const double damping_time : {5e-4, 5e-3}) {  // with the latter a step spans several undamped ones
    auto scene = block_on_slope(std::atan(friction) * 0.9, friction, damping_time);
    auto& simulation = *scene.simulation;
    test::run_until(simulation, 1.0);  // the block settles on its springs
    const auto settled = test::gathered(simulation.mesh(), simulation.positions());
    test::run_until(simulation, 3.0);
    const auto later = test::gathered(simulation.mesh(), simulation.positions());
    const double crept = test::largest_difference(settled, later);
    EXPECT_LE(crept, 1e-6) << "damping " << damping_time << " s";
    test::verify("friction: creep below the angle of friction in 2 s [m], damping time " +
                     std::to_string(damping_time) + " s",
                 "0", crept, "<= 1e-6");
  }
}

TEST(Friction, ImpulsesBalanceTheMomentum) {
  auto scene = block_on_slope(0.5, 0.3, 5e-3);
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure();
  test::run_until(simulation, 0.5);
  const auto now = simulation.measure();
  const auto gained = now.momentum - start.momentum;
  const auto received = now.gravity_impulse + now.contact_impulse + now.constraint_impulse;
  const double unbalanced = norm(gained - received) / norm(now.gravity_impulse);
  EXPECT_LE(unbalanced, 1e-8);
  test::verify("friction: momentum less impulses, over the impulse of gravity", "0", unbalanced, "<= 1e-8");
}

TEST(Bounce, LosesHeightEveryTimeAndNeverGainsEnergy) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  auto scene = test::build(R"(
name: bounce
end_time: 3
gravity: [0, -9.81, 0]
bodies:
  ball:
    mesh: {generate: ball, radius: 0.2, edge_length: 0.1}
    transform: {translate: [0, 0.7, 0]}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 2.0e5, poissons_ratio: 0.3}
    damping: {model: objective, stiffness_proportional: 1.0e-3}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0}
)");
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure();
  const double scale = start.gravitational_energy;
  double energy = start.total_energy();
  double previous_velocity = 0;
  double last_apex = std::numeric_limits<double>::infinity();
  int bounces = 0;
  while (simulation.time() < 3.0) {
    simulation.step(std::min(simulation.suggested_time_step(), 2e-3));
    const auto now = simulation.measure();
    EXPECT_LE(now.total_energy(), energy + 1e-3 * scale) << "at t = " << simulation.time();
    energy = std::min(energy, now.total_energy());
    if (previous_velocity > 0 && now.momentum[1] <= 0) {  // an apex
      EXPECT_LT(now.gravitational_energy, last_apex * (1 + 1e-9));
      last_apex = now.gravitational_energy;
      ++bounces;
    }
    previous_velocity = now.momentum[1];
  }
  EXPECT_GE(bounces, 2);
}

}  // namespace
}  // namespace evert
