// What damping does to angular momentum, and that it damps what is flat.  PHYSICS 4
#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <string>

namespace evert {
namespace {

/// A spinning ball that starts pressed to 0.7 of its height and vibrates: no stretch comes near blend_end.
const std::string vibrating = R"(
name: vibrating
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.2}
    start: {kind: flatten_plane, amplitude: 0.3, axis: [0.3, 1, 0.2]}
    spin: [2, 5, 1]
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 5.0e-3}
integrator: {time_step: 1.0e-3}
petsc: {damping_ksp_rtol: 1e-13}
)";

struct Flight {
  double loss = 0;           // of angular momentum, relative
  double least_stretch = 1;  // of any element at any time
  std::vector<double> end;   // positions
};

Flight fly(const std::string& model, double time_step, double duration = 0.2) {
  auto scene = test::build(
      vibrating, {"bodies.ball.damping.model=" + model, "integrator.time_step=" + std::to_string(time_step)});
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure().angular_momentum;
  Flight flight;
  std::vector<double> stretches;
  const auto look = [&] {
    for (std::size_t block = 0; block < simulation.mesh().cells.size(); ++block) {
      stretches.assign(static_cast<std::size_t>(simulation.mesh().cells[block].size()), 1.0);
      simulation.min_stretch(block, stretches);
      for (const double s : stretches) flight.least_stretch = std::min(flight.least_stretch, s);
    }
  };
  look();
  for (int step = 0; step < std::lround(duration / time_step); ++step) {
    simulation.step(time_step);
    look();
  }
  MPI_Allreduce(MPI_IN_PLACE, &flight.least_stretch, 1, MPI_DOUBLE, MPI_MIN, PETSC_COMM_WORLD);
  flight.loss = norm(simulation.measure().angular_momentum - start) / norm(start);
  flight.end = test::gathered(simulation.mesh(), simulation.positions());
  return flight;
}

/// `objective` exerts no torque at any x; what is left is that of the time step, and of its second order.
TEST(AngularMomentum, IsLostByRotatedDampingAndKeptByTheOthers) {
  const auto rotated = fly("rotated", 1e-3), objective = fly("objective", 1e-3),
             blended = fly("blended", 1e-3);
  const auto finer = fly("objective", 5e-4), rotated_finer = fly("rotated", 5e-4);
  ASSERT_GT(blended.least_stretch, 0.5) << "the threshold of blended";
  test::verify("angular momentum lost in 0.2 s, rotated", "> 0.001", rotated.loss, "-");
  test::verify("angular momentum lost in 0.2 s, objective", "0 (second order in the step)", objective.loss,
               "1e-4");
  test::verify("angular momentum lost in 0.2 s, blended", "that of objective", blended.loss, "1e-12");
  test::verify("loss of objective at half of the step over that at the step", "0.25",
               finer.loss / objective.loss, "0.1");
  EXPECT_GT(rotated.loss, 0.001);
  EXPECT_NEAR(rotated_finer.loss, rotated.loss, 0.1 * rotated.loss) << "no matter of the step";
  EXPECT_LT(objective.loss, 1e-4);
  EXPECT_NEAR(finer.loss / objective.loss, 0.25, 0.1);
  // A = F + 0: the same operator to the bit.
  EXPECT_EQ(blended.loss, objective.loss);
  EXPECT_EQ(test::largest_difference(blended.end, objective.end), 0);
}

/// The share of kinetic energy that is left after 20 ms of a flat block whose nodes move apart across it.
double energy_left(const std::string& model) {
  auto scene = test::build(R"(
name: flat
end_time: 1
bodies:
  block:
    mesh: {generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: tet6}
    start: {kind: flatten_plane, axis: [0, 0, 1]}
    spin: [0, 0, 0]
    density: 1000
    material: {model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}
    damping: {model: rotated, alpha: 2000, beta: 2000}
constraints:
  - {body: block, node_set: z_max, velocity: [[0, 0, 0, 1], [0.001, 0, 0, 1], [0.0010001, 0, 0, 0]], until: 0.001}
integrator: {time_step: 1.0e-4}
)",
                           {"bodies.block.damping.model=" + model});
  auto& simulation = *scene.simulation;
  while (simulation.time() < 1.05e-3) simulation.step(1e-4);
  const double before = simulation.measure().kinetic_energy;
  while (simulation.time() < 21e-3) simulation.step(1e-4);
  return simulation.measure().kinetic_energy / before;
}

TEST(FlatBody, IsDampedByBlendedAndRotatedButNotByObjective) {
  const double rotated = energy_left("rotated"), objective = energy_left("objective"),
               blended = energy_left("blended");
  test::verify("kinetic energy left across a flat block, objective", "about 1", objective, "0.05");
  test::verify("kinetic energy left across a flat block, blended", "that of rotated", blended, "1e-6");
  EXPECT_GT(objective, 0.95);
  EXPECT_LT(rotated, 0.7);
  EXPECT_NEAR(blended, rotated, 1e-6);
}

/// v' = −a v: free flight is slowed down, and the impulses say by how much.
TEST(MassProportionalDamping, SlowsFreeFlightAndIsAccountedFor) {
  for (const std::string damping : {"{model: none, mass_proportional: 3}",
                                    "{model: blended, stiffness_proportional: 1e-3, mass_proportional: 3}"}) {
    auto scene = test::build(vibrating, {"bodies.ball.damping=" + damping, "bodies.ball.start=null",
                                         "bodies.ball.velocity=[1, 2, 3]", "bodies.ball.spin=[0, 0, 0]"});
    auto& simulation = *scene.simulation;
    const auto start = simulation.measure();
    for (int step = 0; step < 500; ++step) simulation.step(1e-3);
    const auto now = simulation.measure();
    const double left = norm(now.momentum) / norm(start.momentum);
    test::verify("momentum left of a flight of 0.5 s, mass-proportional damping 3 /s", "exp(-1.5) = 0.22313",
                 left, "1e-6");
    EXPECT_NEAR(left, std::exp(-1.5), 1e-6);  // of second order: (a Δt)²/12 · 1.5 = 1.1e-6 of it
    EXPECT_LE(norm(now.momentum - start.momentum - now.damping_impulse), 1e-11 * norm(start.momentum));
  }
}

/// Two free cubes, side by side, that breathe along one axis decay with the ratio ξ that the scene gives at
/// its frequency.
TEST(DampingRatio, IsWhatTheVibrationDecaysWith) {
  const std::string bar = R"(
name: bar
end_time: 10
bodies:
  bar:
    mesh: {generate: box, size: [2, 1, 1], cells: [2, 1, 1], cell: hex8}
    start: {kind: flatten_plane, amplitude: 1.0e-5, axis: [0, 0, 1]}
    density: 1000
    material: {model: rotated_linear, youngs_modulus: 1.0e5, poissons_ratio: 0}
integrator: {time_step: 1.0e-4}
petsc: {damping_ksp_rtol: 1e-12}
)";
  // Half of the mass on each side, ν = 0: (ρ h³/2) z̈ = −2 E h z for the faces at ±z, so ω² = 4E/(ρ h²).
  const double frequency = std::sqrt(4 * 1e5 / 1000) / (2 * 3.14159265358979323846);
  const auto energy_after = [&](const std::string& damping) {
    auto scene = test::build(bar, {"bodies.bar.damping=" + damping});
    auto& simulation = *scene.simulation;
    const auto energy = [&] {
      const auto m = simulation.measure();
      return m.kinetic_energy + m.elastic_energy;
    };
    const double before = energy();
    const double period = 1 / (frequency * std::sqrt(1 - 0.05 * 0.05));
    while (simulation.time() < 3 * period - 1e-9)
      simulation.step_to(std::min(simulation.time() + 1e-4, 3 * period));
    return energy() / before;
  };
  const std::string at = "frequency: " + std::to_string(frequency) + "}";
  for (const auto& damping : {"{model: blended, stiffness_ratio: 0.05, " + at,
                              "{model: rotated, stiffness_ratio: 0.02, mass_ratio: 0.03, " + at,
                              "{model: none, mass_ratio: 0.05, " + at}) {
    const double decay = std::sqrt(energy_after(damping));
    const double expected = std::exp(-3 * 2 * 3.14159265358979323846 * 0.05 / std::sqrt(1 - 0.05 * 0.05));
    test::verify(
        "amplitude after three periods, damping ratio 0.05, " + damping.substr(0, damping.rfind(',')) + "}",
        "0.38923", decay, "1e-3");
    EXPECT_NEAR(decay, expected, 1e-3) << damping;
  }
}

}  // namespace
}  // namespace evert
