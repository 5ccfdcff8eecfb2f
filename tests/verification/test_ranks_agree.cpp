// The same scene on any number of ranks, twice, and restarted: the same answer.
#include <gtest/gtest.h>

#include "tests/support/petsc_options.hpp"
#include "tests/support/scenes.hpp"
#include <cmath>

namespace evert {
namespace {

const std::string falling_ball = R"(
name: falling ball
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  ball:
    mesh: {generate: ball, radius: 0.2, edge_length: 0.08}
    transform: {translate: [0, 0.22, 0]}
    density: 1000
    velocity: [1, -3, 0]
    spin: [0, 0, 4]
    material: {model: neo_hookean, youngs_modulus: 5.0e4, poissons_ratio: 0.4}
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.4}
  bump: {shape: sphere, center: [0.1, 0, 0.05], radius: 0.05, friction: 0.1}
events:
  - {at: 0.02, set: bodies.ball.material.youngs_modulus, to: 8.0e4}
)";

class RanksAgree : public testing::TestWithParam<const char*> {
 protected:
  std::vector<std::string> method_{std::string("integrator.method=") + GetParam()};
};

TEST_P(RanksAgree, PositionsAfter200StepsEqualThoseOfOneRank) {
  const auto alone = test::after_steps(*test::build(falling_ball, method_, PETSC_COMM_SELF).simulation, 200);
  auto scene = test::build(falling_ball, method_);
  const auto together = test::after_steps(*scene.simulation, 200);
  EXPECT_LE(test::largest_difference(alone, together), 1e-9 * 0.4);
  EXPECT_GT(norm(scene.simulation->measure().contact_impulse), 0) << "the scene must collide";
}

TEST_P(RanksAgree, TwoRunsAreBitwiseEqual) {
  EXPECT_EQ(test::after_steps(*test::build(falling_ball, method_).simulation, 100),
            test::after_steps(*test::build(falling_ball, method_).simulation, 100));
}

TEST_P(RanksAgree, ARestoredRunIsBitwiseEqual) {
  auto whole = test::build(falling_ball, method_);
  test::after_steps(*whole.simulation, 37);
  const test::KeptState kept(*whole.simulation);
  const auto uninterrupted = test::after_steps(*whole.simulation, 100);

  auto restarted = test::build(falling_ball, method_);
  kept.restore(*restarted.simulation);
  EXPECT_EQ(restarted.simulation->steps(), 37);
  EXPECT_EQ(test::after_steps(*restarted.simulation, 100), uninterrupted);
}

INSTANTIATE_TEST_SUITE_P(All, RanksAgree, testing::Values("newmark", "verlet", "symplectic_euler"));

/// A held and damped beam of quadratic tetrahedra with consistent masses.
const std::string consistent_beam = R"(
name: consistent beam
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  beam:
    mesh: {generate: box, size: [0.6, 0.2, 0.2], cells: [3, 1, 1], cell: tet6}
    order: 2
    density: 1000
    velocity: [0, 1, 0]
    material: {model: neo_hookean, youngs_modulus: 5.0e4, poissons_ratio: 0.4}
    damping: {model: rotated, stiffness_proportional: 1.0e-3, mass_proportional: 2}
constraints: [{body: beam, node_set: x_min, velocity: [[0, 0, 0, 0], [0.1, 0, 0, 1]]}]
integrator: {mass: consistent}
)";

TEST(ConsistentRanksAgree, PositionsAfterTenStepsEqualThoseOfOneRank) {
  for (const char* type : {"shell", "sbaij"}) {
    const test::Options options{{"-damping_mat_type", type}, {"-damping_ksp_rtol", "1e-11"}};
    const auto alone = test::after_steps(*test::build(consistent_beam, {}, PETSC_COMM_SELF).simulation, 10);
    auto scene = test::build(consistent_beam);
    const auto together = test::after_steps(*scene.simulation, 10);
    EXPECT_LE(test::largest_difference(alone, together), 1e-9 * 0.6);
    const auto now = scene.simulation->measure();
    const Vec3d given = now.gravity_impulse + now.constraint_impulse + now.damping_impulse;
    const Vec3d at_start{0, 1000 * 0.024, 0};
    EXPECT_LE(norm(now.momentum - at_start - given), 1e-7 * norm(now.gravity_impulse));
    EXPECT_GT(norm(now.constraint_impulse), 0);
  }
}

TEST(ConsistentRanksAgree, ARestoredRunIsBitwiseEqual) {
  auto whole = test::build(consistent_beam);
  test::after_steps(*whole.simulation, 3);
  const test::KeptState kept(*whole.simulation);
  const auto uninterrupted = test::after_steps(*whole.simulation, 5);
  auto restarted = test::build(consistent_beam);
  kept.restore(*restarted.simulation);
  EXPECT_EQ(test::after_steps(*restarted.simulation, 5), uninterrupted);
}

}  // namespace
}  // namespace evert
