// Bodies that flow with a modal filter, whose elements become flatter than they were made.
#include <gtest/gtest.h>

#include "tests/support/ranks.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <cmath>

namespace evert {
namespace {

/// A ball with slivers.
std::string ball(const std::string& plasticity, const std::string& more) {
  return R"(
name: slivers that flow
end_time: 1
bodies:
  ball:
    mesh: {generate: sliver_ball, radius: 0.2, edge_length: 0.06, jitter: 0.05, thinnest: 0.002}
    transform: {translate: [0, 0.21, 0]}
    density: 1000
    velocity: [1, 0, 0.7]
    material: {model: neo_hookean, youngs_modulus: 2.0e5, poissons_ratio: 0.3}
    damping: {model: blended, stiffness_proportional: 0, mass_proportional: 2}
    plasticity: {)" +
         plasticity + R"(}
)" + more;
}

/// It hits the ground hard and is dented.
std::string dented(const std::string& more) {
  return ball("yield_strain: 0.05, hardening: 0.1, limit: 3", R"(
gravity: [0, -200, 0]
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.4}
)" + more);
}

/// It becomes a disk by itself.
std::string flattened(const std::string& more) {
  return ball("yield_strain: 0.05, limit: 5, goal: {flatten: 0.5, axis: [0, 1, 0], strength: 20}", more);
}

// The slivers allow 0.34 ms, the rest of the ball about three times as much.
const std::string plain = "integrator: {method: verlet, time_step: 1.0e-4}\n";
const std::string filtered = "integrator: {method: verlet, time_step: 5.0e-4}\nfilter: {time_step: 5.0e-4}\n";

GlobalIndex filtered_cells(const Simulation& simulation) {
  GlobalIndex cells = simulation.filter()->filtered_cells();
  MPI_Allreduce(MPI_IN_PLACE, &cells, 1, MPI_INT64_T, MPI_SUM, simulation.mesh().comm);
  return cells;
}

/// Of nodes [m].
double rms(const std::vector<double>& x, const std::vector<double>& y) {
  double square = 0;
  for (std::size_t i = 0; i < x.size(); ++i) square += (x[i] - y[i]) * (x[i] - y[i]);
  return std::sqrt(3 * square / static_cast<double>(x.size()));
}

std::vector<double> positions_at(Simulation& simulation, double end) {
  test::run_until(simulation, end);
  return test::gathered(simulation.mesh(), simulation.positions());
}

TEST(PlasticFilter, DentsAsWithoutIt) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  auto without = test::build(dented(plain)), with = test::build(dented(filtered));
  const double distance = rms(positions_at(*without.simulation, 0.04), positions_at(*with.simulation, 0.04));
  const double work = without.simulation->measure().plastic_work,
               of_filtered = with.simulation->measure().plastic_work;
  EXPECT_GT(work, 100);
  EXPECT_NEAR(of_filtered, work, 0.03 * work);
  EXPECT_LT(distance, 0.01 * 0.4);
  EXPECT_GT(with.simulation->filter()->revision(), 10U);
  test::verify(
      "ball of slivers dented, at steps beyond its own with a filter: plastic work over that without", "1",
      of_filtered / work, "0.03");
  test::verify("  rms distance of the nodes from those without, over the diameter", "0", distance / 0.4,
               "0.01");
}

/// What has flown is filtered for the shape that it has; steps stay those that the filter is for.
TEST(PlasticFilter, FollowsElementsThatBecomeFlat) {
  if (test::shown_on_one_rank()) GTEST_SKIP() << "shown on one rank";
  auto without = test::build(flattened(plain)), with = test::build(flattened(filtered));
  const auto at_first = filtered_cells(*with.simulation);
  const double distance = rms(positions_at(*without.simulation, 0.15), positions_at(*with.simulation, 0.15));
  const auto now = with.simulation->measure();
  // Goals stay with the cells that change their blocks.
  EXPECT_LT(now.goal_distance, 1.1 * std::exp(-20 * 0.15));
  EXPECT_EQ(now.inverted_points, 0);
  EXPECT_LT(distance, 0.01 * 0.4);
  EXPECT_GT(filtered_cells(*with.simulation), at_first);
  EXPECT_EQ(with.simulation->suggested_time_step(), 5e-4);
  test::verify(
      "ball of slivers led to a disk, at steps beyond its own with a filter: filtered cells at the "
      "end over those at first",
      "> 1", static_cast<double>(filtered_cells(*with.simulation)) / static_cast<double>(at_first), "-");
  test::verify("  rms distance of the nodes from those without, over the diameter", "0", distance / 0.4,
               "0.01");
}

TEST(PlasticFilter, DoesNotDependOnTheNumberOfRanks) {
  double largest = 0;
  for (const auto& scene : {dented(filtered), flattened(filtered)}) {
    auto one = test::build(scene, {}, PETSC_COMM_SELF);
    const auto alone = test::after_steps(*one.simulation, 100);
    auto many = test::build(scene);
    largest =
        std::max(largest, test::largest_difference(alone, test::after_steps(*many.simulation, 100)) / 0.4);
    EXPECT_GT(one.simulation->filter()->revision(), 2U);
  }
  EXPECT_LE(largest, 1e-9);
  test::verify("filtered plastic bodies on these ranks against one, 100 steps, over their size", "0", largest,
               "<= 1e-9");
}

/// A restart selects anew, for the shapes of the moment.
TEST(PlasticFilter, GoesOnFromACheckpoint) {
  auto whole = test::build(flattened(filtered));
  test::after_steps(*whole.simulation, 100);
  const test::KeptState kept(*whole.simulation);
  const double work = whole.simulation->measure().control_work;
  auto restarted = test::build(flattened(filtered));
  kept.restore(*restarted.simulation);
  EXPECT_NEAR(restarted.simulation->measure().control_work, work, 1e-12 * work);  // summed in another order
  const auto x = test::after_steps(*whole.simulation, 100), y = test::after_steps(*restarted.simulation, 100);
  const double difference = test::largest_difference(x, y) / 0.4;
  EXPECT_LE(difference, 1e-3);
  test::verify("filtered plastic ball, 100 steps after a restart and without it, over its size", "0",
               difference, "1e-3");
}

}  // namespace
}  // namespace evert
