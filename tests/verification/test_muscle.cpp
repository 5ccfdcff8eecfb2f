// Muscle as scenes have it: where it comes to rest, on any number of ranks, restarted, and through events.
#include "evert/math/nodal.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include <cmath>

namespace evert {
namespace {

const std::string free_strip = R"(
name: free strip
end_time: 1
bodies:
  strip:
    mesh: {generate: box, min: [-0.02, -0.05, -0.02], max: [0.02, 0.05, 0.02], cells: [2, 5, 2], cell: tet6}
    density: 1000
    material: {model: muscle, mu_10: 6e4, mu_01: 2e4, bulk_modulus: 6e5}
    fibres: {direction: [0, 2, 0]}
    activation: [[0, 0], [0.02, 0.8]]
    damping: {model: rotated, stiffness_proportional: 2e-3}
)";

Simulation& run_until(Simulation& simulation, double end) {
  while (simulation.time() < end)
    simulation.step_to(std::min(end, simulation.time() + simulation.suggested_time_step()));
  return simulation;
}

/// Stretches along and across the fibre at which nothing pulls: P̂ = 0, by Newton's method.
std::array<double, 2> stretches_without_stress(const Muscle& muscle) {
  const auto along = muscle.along(Vec3d{1, 0, 0});
  const auto stress = [&](double a, double c) {
    const Mat3d p = along.stress_in_frames({identity<double>(), {a, c, c}, identity<double>()});
    return std::array{p(0, 0), p(1, 1)};
  };
  double a = 1, c = 1;
  for (int i = 0; i < 50; ++i) {
    constexpr double h = 1e-7;
    const auto now = stress(a, c), by_a = stress(a + h, c), by_c = stress(a, c + h);
    const double j00 = (by_a[0] - now[0]) / h, j10 = (by_a[1] - now[1]) / h;
    const double j01 = (by_c[0] - now[0]) / h, j11 = (by_c[1] - now[1]) / h;
    const double determinant = j00 * j11 - j01 * j10;
    a -= (j11 * now[0] - j01 * now[1]) / determinant;
    c -= (j00 * now[1] - j10 * now[0]) / determinant;
  }
  const auto rest = stress(a, c);
  EXPECT_LE(std::abs(rest[0]) + std::abs(rest[1]), 1e-6) << "[Pa]: Newton's method has not found it";
  return {a, c};
}

/// All distances are those of a homogeneous state of these stretches; a mesh that is not symmetric may have
/// turned the strip on the way.
TEST(Muscle, AFreeStripContractsUntilNothingPulls) {
  const auto matrix = MooneyRivlin::from_constants(6e4, 2e4, 6e5);
  const auto [along, across] =
      stretches_without_stress({.lame = matrix.lame, .share_01 = matrix.share_01, .activation = 0.8});
  EXPECT_LT(along, 0.85);
  EXPECT_GT(across, 1.05);
  for (const std::string cell : {"tet6", "hex8", "wedge6"}) {
    const auto scene = test::build(free_strip, {"bodies.strip.mesh.cell=" + cell}, PETSC_COMM_SELF);
    const auto& simulation = run_until(*scene.simulation, 0.3);
    const auto& mesh = simulation.mesh();
    double worst = 0;
    for (LocalIndex a = 0; a < mesh.owned_nodes; ++a) {
      for (LocalIndex b = 0; b < a; ++b) {
        const Vec3d rest = mesh.rest_positions[static_cast<std::size_t>(a)] -
                           mesh.rest_positions[static_cast<std::size_t>(b)];
        const Vec3d now =
            node_value(simulation.positions().owned(), a) - node_value(simulation.positions().owned(), b);
        const double expected = norm(Vec3d{across * rest[0], along * rest[1], across * rest[2]});
        worst = std::max(worst, std::abs(norm(now) - expected));
      }
    }
    EXPECT_LE(worst, 1e-7 * 0.1) << cell;
    EXPECT_EQ(simulation.inverted_points(), 0);
  }
}

/// In free flight nothing but the muscle acts, and it acts on itself only.
TEST(Muscle, KeepsMomentumAndAngularMomentum) {
  const auto scene =
      test::build(free_strip, {"bodies.strip.velocity=[1, 0, 0.5]", "bodies.strip.spin=[3, 1, -2]",
                               "bodies.strip.damping=null", "bodies.strip.fibres.direction=[1, 2, 3]"});
  auto& simulation = *scene.simulation;
  const auto before = simulation.measure();
  while (simulation.time() < 0.02) simulation.step(simulation.suggested_time_step());
  const auto after = simulation.measure();
  EXPECT_LE(norm(after.momentum - before.momentum), 1e-12 * norm(before.momentum));
  EXPECT_LE(norm(after.angular_momentum - before.angular_momentum), 1e-12 * norm(before.angular_momentum));
  EXPECT_GT(std::abs(after.kinetic_energy - before.kinetic_energy), 0.1 * before.kinetic_energy)
      << "the muscle must have moved";
}

/// Curved fibres, middle nodes, a table of activation whose rise is under way, and a held end.
const std::string curved_strip = R"(
name: curved strip
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  strip:
    mesh: {generate: box, min: [0, 0, 0], max: [0.1, 0.04, 0.04], cells: [5, 2, 2], cell: tet6}
    order: 2
    density: 1000
    material: {model: muscle, mu_10: 6e4, mu_01: 2e4, bulk_modulus: 6e5}
    fibres: {curve: [[0, 0, 0], [0.03, 0.01, 0], [0.06, 0, 0.02], [0.1, 0.03, 0.01]]}
    activation: [[0.001, 0], [0.03, 1], [0.05, 0.2]]
    damping: {model: rotated, stiffness_proportional: 1e-3}
constraints:
  - {body: strip, node_set: x_min, fixed: true}
events:
  - {at: 0.004, set: gravity, to: [0, 0, -9.81]}
)";

TEST(Muscle, OfSeveralRanksIsThatOfOne) {
  const auto alone = test::after_steps(*test::build(curved_strip, {}, PETSC_COMM_SELF).simulation, 100);
  const auto scene = test::build(curved_strip);
  EXPECT_LE(test::largest_difference(alone, test::after_steps(*scene.simulation, 100)), 1e-9 * 0.1);
  EXPECT_GT(scene.simulation->time(), 0.002) << "muscle must have become active";
  const auto straight =
      test::build(curved_strip, {"bodies.strip.fibres={direction: [1, 0, 0]}"}, PETSC_COMM_SELF);
  EXPECT_GT(test::largest_difference(alone, test::after_steps(*straight.simulation, 100)), 1e-6)
      << "the direction must matter";
}

TEST(Muscle, RestoredIsBitwiseEqual) {
  const auto whole = test::build(curved_strip);
  test::after_steps(*whole.simulation, 23);
  whole.simulation->step_to(whole.simulation->time() + 1e-5 / 3);
  const test::KeptState kept(*whole.simulation);
  const auto restarted = test::build(curved_strip);
  kept.restore(*restarted.simulation);
  EXPECT_EQ(test::after_steps(*restarted.simulation, 60), test::after_steps(*whole.simulation, 60));
}

TEST(Muscle, StableStepHoldsForTheActivationToCome) {
  const auto first_step = [](const std::string& activation) {
    const auto scene = test::build(free_strip, {"bodies.strip.activation=" + activation});
    auto& simulation = *scene.simulation;
    const double energy = simulation.measure().elastic_energy;
    const double dt = simulation.suggested_time_step();
    EXPECT_EQ(simulation.measure().elastic_energy, energy) << "looking ahead changes nothing";
    return dt;
  };
  EXPECT_LT(first_step("1"), first_step("0"));
  EXPECT_EQ(first_step("[[0, 0], [1e-6, 1]]"), first_step("1"));
  EXPECT_EQ(first_step("[[0, 1], [1e-6, 0]]"), first_step("1"));
  EXPECT_EQ(first_step("[[0, 0], [1, 0], [1.001, 1]]"), first_step("0")) << "not for what is far ahead";
}

TEST(Muscle, KeyframesAreEvents) {
  const auto scene = test::build(free_strip, {"bodies.strip.activation=[[0, 0], [0.01, 1], [0.03, 0]]"});
  EXPECT_EQ(scene.simulation->next_event(), 0.01);
  scene.simulation->step_to(0.01);
  EXPECT_EQ(scene.simulation->next_event(), 0.03);
}

/// An event that sets a modulus to what it is must not forget the activation.
TEST(Muscle, StaysActiveThroughEvents) {
  const std::vector<std::string> by_modulus{
      "bodies.strip.material={model: muscle, youngs_modulus: 4e5, poissons_ratio: 0.4}"};
  auto with_event = by_modulus;
  with_event.emplace_back(
      "events=[{at: 0.004, set: bodies.strip.material.youngs_modulus, to: 4e5}, {at: 0.004, set: gravity, "
      "to: "
      "[0, 0, -9.81]}]");
  const auto plain = test::build(curved_strip, by_modulus);
  const auto changed = test::build(curved_strip, with_event);
  for (const auto* scene : {&plain, &changed}) run_until(*scene->simulation, 0.004);
  for (const auto* scene : {&plain, &changed})
    for (int step = 1; step <= 40; ++step) scene->simulation->step_to(0.004 + 1e-4 * step);
  EXPECT_LE(
      test::largest_difference(test::gathered(plain.simulation->mesh(), plain.simulation->positions()),
                               test::gathered(changed.simulation->mesh(), changed.simulation->positions())),
      1e-9 * 0.1);
}

TEST(Activation, IsLinearBetweenItsKeyframes) {
  const Activation activation{0, {{1, 0.2}, {3, 1}, {4, 0}}};
  const std::array<std::array<double, 2>, 8> expected{
      {{-1, 0.2}, {1, 0.2}, {1.5, 0.4}, {2, 0.6}, {3, 1}, {3.25, 0.75}, {4, 0}, {100, 0}}};
  for (const auto& [time, value] : expected) EXPECT_DOUBLE_EQ(activation.at(time), value) << time;
  EXPECT_DOUBLE_EQ(activation.rise(1.5, 2), 0.2);
  EXPECT_DOUBLE_EQ(activation.rise(2, 100), 0.4) << "the highest is in between";
  EXPECT_DOUBLE_EQ(activation.rise(3, 4), 0);
  EXPECT_EQ(activation.next_keyframe(0), 1);
  EXPECT_EQ(activation.next_keyframe(1), 3);
  EXPECT_EQ(activation.next_keyframe(4), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace evert
