// An elastic body without obstacles: what Newmark's scheme must conserve, and its order.
#include <gtest/gtest.h>

#include "tests/support/free_flight.hpp"
#include "tests/support/petsc_options.hpp"
#include "tests/support/ranks.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

using test::half_stable_step;
using test::spinning_ball;

class ElasticModels : public testing::TestWithParam<const char*> {
 protected:
  BuiltScene scene_ = test::build(spinning_ball, {std::string("bodies.ball.material.model=") + GetParam()});
};

/// The largest of 10,000 steps, relative to the start.
struct Drift {
  double energy = 0, momentum = 0, angular_momentum = 0;
};

Drift drift_of_flight(Simulation& simulation, double dt) {
  const auto start = simulation.measure();
  const double energy = start.kinetic_energy + start.elastic_energy;
  Drift drift;
  for (int step = 0; step < 10000; ++step) {
    simulation.step(dt);
    if (step % 500 != 499) continue;
    const auto now = simulation.measure();
    drift.energy =
        std::max(drift.energy, std::abs(now.kinetic_energy + now.elastic_energy - energy) / energy);
    drift.momentum = std::max(drift.momentum, norm(now.momentum - start.momentum) / norm(start.momentum));
    drift.angular_momentum =
        std::max(drift.angular_momentum,
                 norm(now.angular_momentum - start.angular_momentum) / norm(start.angular_momentum));
  }
  return drift;
}

/// `flight` ends with "relative drift of ".
void expect_conserved(const Drift& drift, const std::string& flight) {
  test::verify(flight + "energy", "0", drift.energy, "<= 1e-3");
  test::verify(flight + "momentum", "0", drift.momentum, "<= 1e-12");
  test::verify(flight + "angular momentum", "0", drift.angular_momentum, "<= 1e-10");
  EXPECT_LE(drift.energy, 1e-3);
  EXPECT_LE(drift.momentum, 1e-12);
  EXPECT_LE(drift.angular_momentum, 1e-10);
}

TEST_P(ElasticModels, ConserveMomentaAndEnergyOver10000Steps) {
  if (test::shown_on_one_rank() && GetParam() != std::string("neo_hookean"))
    GTEST_SKIP() << "shown on one rank";
  auto& simulation = *scene_.simulation;
  const auto drift = drift_of_flight(simulation, half_stable_step(simulation));
  const std::string flight =
      std::string("free flight of 10,000 steps, ") + GetParam() + ": relative drift of ";
  expect_conserved(drift, flight);
}

/// positions_with(steps) gives those at one end time.
template <class Positions>
void expect_second_order(const Positions& positions_with, const std::string& what) {
  const auto reference = positions_with(640);
  const double coarse = test::largest_difference(positions_with(40), reference);
  const double fine = test::largest_difference(positions_with(80), reference);
  const double order = std::log2(coarse / fine);
  test::verify("order of Newmark's scheme in the time step, " + what, "2", order, "1.9 to 2.1");
  EXPECT_GE(order, 1.9);
  EXPECT_LE(order, 2.1);
}

TEST_P(ElasticModels, AreOfSecondOrderInTheStep) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
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

class ConsistentFlight : public testing::TestWithParam<const char*> {};

/// The element and its masses take part in a flight of the same body. Momentum is balanced to the tolerance
/// of the solves, which is set so that 10,000 steps of it are 1e-12.
TEST_P(ConsistentFlight, ConservesMomentaAndEnergyOver10000Steps) {
  if (test::shown_on_one_rank() && GetParam() != std::string("tet4")) GTEST_SKIP() << "shown on one rank";
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-14"}};
  const std::string mesh =
      GetParam() == std::string("hex8") || GetParam() == std::string("wedge6")
          ? std::string("{generate: box, size: [0.8, 0.6, 0.5], cells: [2, 2, 2], cell: ") + GetParam() + "}"
          : "{generate: box, size: [0.8, 0.6, 0.5], cells: [1, 1, 1], cell: tet6}";
  auto scene = test::build(
      spinning_ball, {"bodies.ball.mesh=" + mesh,
                      std::string("bodies.ball.order=") + (GetParam() == std::string("tet10") ? "2" : "1"),
                      "integrator={mass: consistent}"});
  auto& simulation = *scene.simulation;
  const auto drift = drift_of_flight(simulation, half_stable_step(simulation));
  const std::string flight =
      std::string("free flight of 10,000 steps, consistent masses, ") + GetParam() + ": relative drift of ";
  expect_conserved(drift, flight);
}

INSTANTIATE_TEST_SUITE_P(All, ConsistentFlight, testing::Values("tet4", "hex8", "wedge6", "tet10"));

TEST(ConsistentMasses, AreOfSecondOrderInTheStep) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  const std::vector<std::string> consistent{
      "bodies.ball.mesh={generate: box, size: [0.8, 0.6, 0.5], cells: [1, 1, 1], cell: tet6}",
      "bodies.ball.order=2", "integrator={mass: consistent}"};
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-12"}};
  const double end = 20 * half_stable_step(*test::build(spinning_ball, consistent).simulation);
  const auto positions_with = [&](int steps) {
    auto scene = test::build(spinning_ball, consistent);
    for (int step = 0; step < steps; ++step) scene.simulation->step(end / steps);
    return test::gathered(scene.simulation->mesh(), scene.simulation->positions());
  };
  expect_second_order(positions_with, "consistent masses");
}

TEST(Damping, IsOfSecondOrderAndOnlyTakesEnergy) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  const test::Options tolerance{{"-damping_ksp_rtol", "1e-12"}};
  const std::vector<std::string> damped{
      "bodies.ball.damping={model: rotated, stiffness_proportional: 2.0e-3}"};
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
  expect_second_order(positions_with, "damped");
}

}  // namespace
}  // namespace evert
