// The explicit schemes in free flight: their order, what they conserve, and what becomes of explicit Euler.
#include "evert/core/error.hpp"
#include "evert/filter/spectrum.hpp"

#include <gtest/gtest.h>

#include "tests/support/free_flight.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

using test::half_stable_step;
using test::spinning_ball;

struct Scheme {
  const char* method;
  int order;
  bool damped;
};

class Order : public testing::TestWithParam<Scheme> {};

TEST_P(Order, InTheStepIsWhatTheSchemeSays) {
  const auto [method, order, damped] = GetParam();
  const std::string reference_method = "integrator.method=verlet";
  // Deformed at the start: from rest, without forces, symplectic Euler happens to be of second order.
  std::vector<std::string> overrides{std::string("integrator.method=") + method, "integrator.time_step=1e-3",
                                     "bodies.ball.start={kind: flatten_plane, amplitude: 0.05}"};
  // Objective damping: C varies along the motion.
  if (damped)
    overrides.emplace_back("bodies.ball.damping={model: objective, stiffness_proportional: 5.0e-4}");
  const double end = 10 * half_stable_step(*test::build(spinning_ball, overrides).simulation);
  const auto positions_with = [&](int steps, const std::vector<std::string>& options) {
    auto scene = test::build(spinning_ball, options);
    for (int step = 0; step < steps; ++step) scene.simulation->step(end / steps);
    return test::gathered(scene.simulation->mesh(), scene.simulation->positions());
  };
  auto exact = overrides;
  exact[0] = reference_method;
  const auto reference = positions_with(8000, exact);
  const double coarse = test::largest_difference(positions_with(320, overrides), reference);
  const double fine = test::largest_difference(positions_with(640, overrides), reference);
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.1);
  test::verify(std::string("order of ") + method + " in the time step" + (damped ? ", damped" : ""),
               std::to_string(order), std::log2(coarse / fine), "0.1");
}

INSTANTIATE_TEST_SUITE_P(All, Order,
                         testing::Values(Scheme{"verlet", 2, false}, Scheme{"verlet", 2, true},
                                         Scheme{"symplectic_euler", 1, false},
                                         Scheme{"symplectic_euler", 1, true},
                                         Scheme{"explicit_euler", 1, false},
                                         Scheme{"explicit_euler", 1, true}));

class Flight : public testing::TestWithParam<const char*> {};

TEST_P(Flight, ConservesMomentaAndEnergyOver10000Steps) {
  const std::string method = GetParam();
  auto scene = test::build(spinning_ball, {"integrator.method=" + method});
  auto& simulation = *scene.simulation;
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
  // Of symplectic Euler the energy at whole steps differs by a share of ωΔt/2 of the elastic energy.
  const double most = method == "verlet" ? 1e-3 : 2e-2;
  EXPECT_LE(energy_drift, most);
  EXPECT_LE(momentum_drift, 1e-12);
  EXPECT_LE(angular_drift, 1e-10);
  const auto flight = "free flight of 10,000 steps, " + method + ": relative drift of ";
  test::verify(flight + "energy", "0", energy_drift, method == "verlet" ? "<= 1e-3" : "<= 2e-2");
  test::verify(flight + "momentum", "0", momentum_drift, "<= 1e-12");
  test::verify(flight + "angular momentum", "0", angular_drift, "<= 1e-10");
}

INSTANTIATE_TEST_SUITE_P(All, Flight, testing::Values("verlet", "symplectic_euler"));

/// A body at rest but for a small velocity in its fastest vibration.
struct Vibrating {
  BuiltScene scene;
  double frequency;  // [rad/s]

  explicit Vibrating(const std::string& method)
      : scene(test::build(spinning_ball, {"integrator.method=" + method, "integrator.time_step=1e-3",
                                          "bodies.ball.velocity=[0, 0, 0]", "bodies.ball.spin=[0, 0, 0]"})) {
    auto& simulation = *scene.simulation;
    NodeField x(simulation.mesh());
    std::ranges::copy(simulation.positions().owned(), x.owned().begin());
    MassScaledStiffness stiffness(simulation.mesh(), simulation.elastic());
    stiffness.assemble(x);
    const auto mode = fastest_mode(stiffness);
    frequency = std::sqrt(mode.squared_frequency);
    std::vector<double> velocities(x.owned().size());
    const PetscScalar* scaled = nullptr;
    check(VecGetArrayRead(mode.scaled.get(), &scaled));
    for (std::size_t i = 0; i < velocities.size(); ++i)
      velocities[i] = 1e-2 * scaled[i] / std::sqrt(simulation.elastic().masses()[i / 3]);
    check(VecRestoreArrayRead(mode.scaled.get(), &scaled));
    auto state = simulation.node_state();
    const auto scalars = simulation.state_scalars();
    const std::vector<double> changes(state.velocity_changes.begin(), state.velocity_changes.end());
    const std::vector<double> positions(state.positions.begin(), state.positions.end());
    simulation.restore({positions, velocities, changes}, scalars);
  }

  [[nodiscard]] double energy() const {
    const auto now = scene.simulation->measure();
    return now.kinetic_energy + now.elastic_energy;
  }
};

TEST(ExplicitEuler, GainsEnergyInEveryStepAtTheRateOfTheory) {
  for (const double share : {0.02, 0.2}) {
    Vibrating vibrating("explicit_euler");
    const double dt = share / vibrating.frequency;
    const double before = vibrating.energy();
    double last = before;
    constexpr int steps = 50;
    for (int step = 0; step < steps; ++step) {
      vibrating.scene.simulation->step(dt);
      EXPECT_GT(vibrating.energy(), last);
      last = vibrating.energy();
    }
    const double growth = std::pow(last / before, 1.0 / steps) - 1;
    EXPECT_NEAR(growth, share * share, 0.01 * share * share);
    test::verify("explicit_euler: growth of energy in a step of " + std::to_string(share) + "/ω, over (ωΔt)²",
                 "1", growth / (share * share), "1 %");
  }
}

TEST(ExplicitEuler, BlowsUpWhereOthersFly) {
  const auto run = [](const char* method) {
    auto scene =
        test::build(spinning_ball, {std::string("integrator.method=") + method, "integrator.time_step=1e-3"});
    auto& simulation = *scene.simulation;
    const double dt = half_stable_step(simulation);
    for (int step = 0; step < 5000; ++step) simulation.step(dt);
  };
  EXPECT_NO_THROW(run("symplectic_euler"));
  EXPECT_THROW(run("explicit_euler"), SimulationError);
}

}  // namespace
}  // namespace evert
