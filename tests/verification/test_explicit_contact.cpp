// Obstacles, held nodes and the balance of momentum with damping taken explicitly.
#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <cmath>

namespace evert {
namespace {

class ExplicitContact : public testing::TestWithParam<const char*> {
 protected:
  const std::string method_ = GetParam();

  /// A block on a plane tilted by `angle` [rad]: gravity is tilted instead of the plane.
  BuiltScene block_on_slope(double angle, double friction, const std::vector<std::string>& more = {}) {
    std::vector<std::string> overrides{"integrator.method=" + method_,
                                       "gravity=[" + std::to_string(9.81 * std::sin(angle)) + ", " +
                                           std::to_string(-9.81 * std::cos(angle)) + ", 0]",
                                       "obstacles.plane.friction=" + std::to_string(friction)};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return test::build(R"(
name: slope
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  block:
    mesh: {generate: box, min: [-0.1, 0, -0.1], max: [0.1, 0.05, 0.1], cells: [4, 1, 4], cell: tet6}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
obstacles:
  plane: {shape: half_space, normal: [0, 1, 0], friction: 0.3}
)",
                       overrides);
  }

  static double run_until(Simulation& simulation, double end) {
    while (simulation.time() < end) {
      const double steps = std::ceil((end - simulation.time()) / simulation.suggested_time_step() - 1e-9);
      steps <= 1 ? simulation.step_to(end) : simulation.step((end - simulation.time()) / steps);
    }
    return simulation.time();
  }
};

TEST_P(ExplicitContact, SlidesWithCoulombsAcceleration) {
  const double angle = 0.5, friction = 0.3, mass = 1000 * 0.2 * 0.05 * 0.2;
  auto scene = block_on_slope(angle, friction);
  auto& simulation = *scene.simulation;
  const double begin = run_until(simulation, 0.2);
  const double before = simulation.measure().momentum[0] / mass;
  const double end = run_until(simulation, 0.5);
  const double acceleration = (simulation.measure().momentum[0] / mass - before) / (end - begin);
  const double expected = 9.81 * (std::sin(angle) - friction * std::cos(angle));
  EXPECT_NEAR(acceleration / expected, 1, 0.01);
  test::verify("friction, " + method_ + ": acceleration on a slope over Coulomb's", "1",
               acceleration / expected, "0.99 to 1.01");
}

TEST_P(ExplicitContact, SticksBelowTheCoulombAngle) {
  auto scene = block_on_slope(std::atan(0.3) * 0.9, 0.3);
  auto& simulation = *scene.simulation;
  run_until(simulation, 1.0);
  const auto settled = test::gathered(simulation.mesh(), simulation.positions());
  run_until(simulation, 2.0);
  const double crept =
      test::largest_difference(settled, test::gathered(simulation.mesh(), simulation.positions()));
  EXPECT_LE(crept, 1e-6);
  test::verify("friction, " + method_ + ": creep below the angle of friction in 1 s [m]", "0", crept,
               "<= 1e-6");
}

TEST_P(ExplicitContact, ImpulsesBalanceTheMomentum) {
  // One side is pulled along; damping proportional to mass takes a part.
  auto scene = block_on_slope(0.5, 0.3,
                              {"constraints=[{body: block, node_set: x_min, velocity: [[0, 0, 0, 0], "
                               "[0.1, -0.3, 0.1, 0]], axes: [true, true, false]}]",
                               "bodies.block.damping.mass_proportional=2"});
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure();
  run_until(simulation, 0.2);
  const auto now = simulation.measure();
  const auto received =
      now.gravity_impulse + now.contact_impulse + now.constraint_impulse + now.damping_impulse;
  EXPECT_GT(norm(now.constraint_impulse), 0.01 * norm(now.gravity_impulse));
  EXPECT_GT(norm(now.contact_impulse), 0.01 * norm(now.gravity_impulse));
  EXPECT_GT(norm(now.damping_impulse), 1e-4 * norm(now.gravity_impulse));
  const double unbalanced = norm(now.momentum - start.momentum - received) / norm(now.gravity_impulse);
  EXPECT_LE(unbalanced, 1e-11);
  test::verify("momentum less impulses over that of gravity, " + method_, "0", unbalanced, "<= 1e-11");
}

TEST_P(ExplicitContact, HeldNodesMoveAsPrescribed) {
  auto scene = block_on_slope(
      0, 0.3, {"constraints=[{body: block, node_set: x_min, velocity: [0.2, 0, 0.1]}]", "obstacles={}"});
  auto& simulation = *scene.simulation;
  const auto before = test::gathered(simulation.mesh(), simulation.positions());
  const double duration = run_until(simulation, 0.1);
  const auto after = test::gathered(simulation.mesh(), simulation.positions());
  int held = 0;
  for (std::size_t i = 0; i < before.size(); i += 3) {
    if (before[i] > -0.1 + 1e-9) continue;
    ++held;
    EXPECT_NEAR(after[i] - before[i], 0.2 * duration, 1e-12);
    EXPECT_NEAR(after[i + 1] - before[i + 1], 0, 1e-12);
    EXPECT_NEAR(after[i + 2] - before[i + 2], 0.1 * duration, 1e-12);
  }
  EXPECT_EQ(held, 10);
}

TEST_P(ExplicitContact, TheAutomaticStepIsStableHoweverStiffTheDamping) {
  // Energy only falls: ten times over the limit of the undamped body, with every model of damping.
  for (const std::string model : {"rotated", "objective", "blended"}) {
    auto scene = test::build(R"(
name: stretched
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.25}
    density: 1000
    start: {kind: flatten_plane, amplitude: 0.4}
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 0.02}
)",
                             {"integrator.method=" + method_, "bodies.ball.damping.model=" + model});
    auto& simulation = *scene.simulation;
    const double begin = simulation.measure().elastic_energy;
    double energy = begin;
    for (int step = 0; step < 300; ++step) {
      simulation.step(simulation.suggested_time_step());
      const auto now = simulation.measure();
      EXPECT_LE(now.kinetic_energy + now.elastic_energy, energy + 1e-3 * begin) << model << " " << step;
      energy = now.kinetic_energy + now.elastic_energy;
    }
    EXPECT_LT(energy, 0.9 * begin) << model;
  }
}

TEST_P(ExplicitContact, DampingWithoutElasticityLimitsTheStepToo) {
  auto scene = test::build(R"(
name: dough
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.25}
    density: 1000
    spin: [0, 0, 1]
    material: {model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0.3}
    damping: {model: rotated, alpha: 1.0e4, beta: 1.0e4}
)",
                           {"integrator.method=" + method_, "integrator.max_strain_increment=1"});
  auto& simulation = *scene.simulation;
  double energy = simulation.measure().kinetic_energy;
  for (int step = 0; step < 200; ++step) {
    simulation.step(simulation.suggested_time_step());
    const double now = simulation.measure().kinetic_energy;
    EXPECT_LE(now, energy * (1 + 1e-9));
    energy = now;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ExplicitContact, testing::Values("verlet", "symplectic_euler"));

}  // namespace
}  // namespace evert
