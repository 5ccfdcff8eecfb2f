// An elastic body without obstacles: what Newmark's scheme must conserve, and its order.
#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

const std::string spinning_ball = R"(
name: free flight
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.25}
    density: 1000
    velocity: [0.3, -0.2, 0.1]
    spin: [1.0, 2.0, -1.5]
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
)";

/// Half of the undamped bound: `auto` with safety 1 suggests the bound itself, strain limits aside.
double half_stable_step(Simulation& simulation) {
  return 0.5 * simulation.elastic().stable_step(simulation.positions()).undamped;
}

class ElasticModels : public testing::TestWithParam<const char*> {
 protected:
  BuiltScene scene_ = test::build(spinning_ball, {std::string("bodies.ball.material.model=") + GetParam()});
};

TEST_P(ElasticModels, ConserveMomentaAndEnergyOver10000Steps) {
  auto& simulation = *scene_.simulation;
  const double dt = half_stable_step(simulation);
  const auto start = simulation.measure();
  const double energy = start.kinetic_energy + start.elastic_energy;
  double energy_drift = 0, momentum_drift = 0, angular_drift = 0;
  for (int step = 0; step < 10000; ++step) {
    simulation.step(dt);
    if (step % 500 != 499) continue;
    const auto now = simulation.measure();
    energy_drift =
        std::max(energy_drift, std::abs(now.kinetic_energy + now.elastic_energy - energy) / energy);
    momentum_drift = std::max(momentum_drift, norm(now.momentum - start.momentum) / norm(start.momentum));
    angular_drift = std::max(
        angular_drift, norm(now.angular_momentum - start.angular_momentum) / norm(start.angular_momentum));
  }
  EXPECT_LE(energy_drift, 1e-3);
  EXPECT_LE(momentum_drift, 1e-12);
  EXPECT_LE(angular_drift, 1e-10);
  const std::string flight =
      std::string("free flight of 10,000 steps, ") + GetParam() + ": relative drift of ";
  test::verify(flight + "energy", "0", energy_drift, "<= 1e-3");
  test::verify(flight + "momentum", "0", momentum_drift, "<= 1e-12");
  test::verify(flight + "angular momentum", "0", angular_drift, "<= 1e-10");
}

TEST_P(ElasticModels, AreOfSecondOrderInTheStep) {
  const double end = 20 * half_stable_step(*scene_.simulation);
  const auto positions_with = [&](int steps) {
    auto scene = test::build(spinning_ball, {std::string("bodies.ball.material.model=") + GetParam()});
    for (int step = 0; step < steps; ++step) scene.simulation->step(end / steps);
    return test::gathered(scene.simulation->mesh(), scene.simulation->positions());
  };
  // From a quarter of the stable step: closer to the limit, terms of fourth order still show.
  const auto reference = positions_with(2560);
  const double coarse = test::largest_difference(positions_with(40), reference);
  const double middle = test::largest_difference(positions_with(80), reference);
  const double fine = test::largest_difference(positions_with(160), reference);
  for (const double order : {std::log2(coarse / middle), std::log2(middle / fine)}) {
    EXPECT_GE(order, 1.9);
    EXPECT_LE(order, 2.1);
  }
  test::verify(std::string("order of Newmark's scheme in the time step, ") + GetParam(), "2",
               std::log2(middle / fine), "1.9 to 2.1");
}

INSTANTIATE_TEST_SUITE_P(All, ElasticModels,
                         testing::Values("neo_hookean", "rotated_linear", "st_venant_kirchhoff",
                                         "mooney_rivlin", "spline", "stable_neo_hookean"));

TEST(Damping, IsOfSecondOrderAndOnlyTakesEnergy) {
  const std::vector<std::string> damped{
      "bodies.ball.damping={model: rotated, stiffness_proportional: 2.0e-3}", "petsc.damping_ksp_rtol=1e-12"};
  const double end = 20 * half_stable_step(*test::build(spinning_ball, damped).simulation);
  const auto positions_with = [&](int steps) {
    auto scene = test::build(spinning_ball, damped);
    auto& simulation = *scene.simulation;
    double energy = std::numeric_limits<double>::infinity();
    for (int step = 0; step < steps; ++step) {
      simulation.step(end / steps);
      const auto now = simulation.measure();
      EXPECT_LE(now.kinetic_energy + now.elastic_energy, energy * (1 + 1e-6));
      energy = now.kinetic_energy + now.elastic_energy;
    }
    return test::gathered(simulation.mesh(), simulation.positions());
  };
  const auto reference = positions_with(640);
  const double coarse = test::largest_difference(positions_with(40), reference);
  const double fine = test::largest_difference(positions_with(80), reference);
  EXPECT_GE(std::log2(coarse / fine), 1.9);
  EXPECT_LE(std::log2(coarse / fine), 2.1);
  test::verify("order of Newmark's scheme in the time step, damped", "2", std::log2(coarse / fine),
               "1.9 to 2.1");
}

}  // namespace
}  // namespace evert
