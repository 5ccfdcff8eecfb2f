// examples/hex_puddle, of 216 hexahedra: collapses, and is whole again.
#include "evert/sim/shape_error.hpp"

#include <gtest/gtest.h>

#include "tests/support/examples.hpp"
#include "tests/support/verify.hpp"

namespace evert {
namespace {

void run_until(Simulation& simulation, double end) {
  while (simulation.time() < end) {
    const double dt = simulation.suggested_time_step();  // applies the events that are due
    const double stop = std::min(end, simulation.next_event());
    dt < stop - simulation.time() ? simulation.step(dt) : simulation.step_to(stop);
  }
}

double height(const Simulation& simulation) {
  double highest = 0;
  for (std::size_t i = 1; i < simulation.positions().owned().size(); i += 3)
    highest = std::max(highest, simulation.positions().owned()[i]);
  MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return highest;
}

TEST(HexPuddle, CollapsesAndRecoversWithNothingInverted) {
  auto scene =
      test::build_example("hex_puddle", {"bodies.ring.mesh.cells=[9, 9, 3]", "bodies.ring.mesh.hole=[3, 3]"});
  auto& simulation = *scene.simulation;
  const auto& mesh = simulation.mesh();
  constexpr double points = 216 * 8, rest_height = 1.0 / 3;
  double most_inverted = 0;
  for (int tenth = 1; tenth <= 16; ++tenth) {
    run_until(simulation, 0.1 * tenth);
    most_inverted = std::max(most_inverted, static_cast<double>(simulation.inverted_points()) / points);
  }
  const double puddle = height(simulation);
  run_until(simulation, 3);
  const double error = rms_shape_error(mesh, simulation.positions(), 0, mesh.total_nodes);
  test::verify("hex puddle, share of inverted points at most", "> 0.25", most_inverted, "-");
  test::verify("hex puddle, height before recovery over that of the ring", "< 0.3", puddle / rest_height,
               "-");
  test::verify("hex puddle, inverted points at the end", "0",
               static_cast<double>(simulation.inverted_points()), "0");
  test::verify("hex puddle, RMS distance from its shape at the end [m]", "< 0.02", error, "-");
  EXPECT_GT(most_inverted, 0.25);
  EXPECT_LT(puddle, 0.3 * rest_height);
  EXPECT_EQ(simulation.inverted_points(), 0);
  EXPECT_LT(error, 0.02);
}

}  // namespace
}  // namespace evert
