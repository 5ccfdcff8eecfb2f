// examples/ball_drop, on a coarse mattress: the ball sinks in and is thrown back, and nothing comes from
// nowhere.

#include <gtest/gtest.h>

#include "tests/support/examples.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>

namespace evert {
namespace {

TEST(BallDrop, SinksInAndIsThrownBack) {
  constexpr double start_height = 1.2, radius = 0.25, thickness = 0.3;
  auto scene = test::build_example("ball_drop", {"bodies.mattress.mesh.edge_length=0.2"});
  auto& simulation = *scene.simulation;
  const auto* ball = simulation.obstacles().back()->body();
  ASSERT_NE(ball, nullptr);
  const auto start = simulation.measure();
  double lowest = start_height, highest_after = 0;
  while (simulation.time() < 1) {
    simulation.step(simulation.suggested_time_step());
    const double height = ball->center()[1];
    if (height < lowest) highest_after = 0;
    lowest = std::min(lowest, height);
    highest_after = std::max(highest_after, height);
  }
  const auto end = simulation.measure();
  const auto received = end.gravity_impulse + end.contact_impulse;
  const double unbalanced = norm(end.momentum - start.momentum - received) / norm(end.gravity_impulse);
  test::verify("ball drop, depth that the ball sinks in over the thickness of the mattress", "> 0.2",
               (thickness + radius - lowest) / thickness, "-");
  test::verify("ball drop, height of the rebound over that of the fall", "0.1 to 0.9",
               (highest_after - lowest) / (start_height - lowest), "-");
  test::verify("ball drop, momentum less impulses over the impulse of gravity", "0", unbalanced, "<= 1e-6");
  test::verify("ball drop, energy at the end over that at the start", "< 1",
               end.total_energy() / start.total_energy(), "-");
  EXPECT_GT((thickness + radius - lowest) / thickness, 0.2);
  EXPECT_GT((highest_after - lowest) / (start_height - lowest), 0.1);
  EXPECT_LT((highest_after - lowest) / (start_height - lowest), 0.9);
  EXPECT_LE(unbalanced, 1e-6);
  EXPECT_LT(end.total_energy(), start.total_energy());
  EXPECT_EQ(simulation.inverted_points(), 0);
}

}  // namespace
}  // namespace evert
