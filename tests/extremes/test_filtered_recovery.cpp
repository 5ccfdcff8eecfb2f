// Bodies with filtered elements, from scrambled, flattened, collapsed and inside-out starts back to rest.
#include "evert/sim/shape_error.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <array>
#include <string>

namespace evert {
namespace {

/// As in test_recovery.cpp: first untangle with the momentum of the recoil, then cool, then come to rest; and
/// lose the spin that is left over, whose centrifugal force alone stretches the box by 2e-9 m.
const std::string scene = R"(
name: filtered recovery
end_time: 100
bodies:
  body:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.35}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.4, compression_limit: 0.99}
    damping: {model: objective, stiffness_proportional: 1.0e-5, mass_proportional: 0}
integrator: {max_strain_increment: 0.05}
filter: {time_step: 6.5e-3}
events:
  - {at: 2, set: bodies.body.damping.stiffness_proportional, to: 1.0e-4}
  - {at: 4, set: bodies.body.damping.stiffness_proportional, to: 0.02}
  - {at: 4, set: bodies.body.damping.mass_proportional, to: 3}
)";

/// A mesh and a step that is too large for many of its elements.
struct Body {
  const char* name;
  std::string mesh, step;
};
const std::array<Body, 3> bodies{
    {{"ball", "bodies.body.mesh={generate: ball, radius: 0.5, edge_length: 0.35}", "filter.time_step=6.5e-3"},
     {"box",
      "bodies.body.mesh={generate: box, min: [-0.5, -0.2, -0.2], max: [0.5, 0.2, 0.2], cells: [5, 2, 2], "
      "cell: tet6}",
      "filter.time_step=6e-3"},
     {"ellipsoid", "bodies.body.mesh={generate: ellipsoid, radii: [0.5, 0.35, 0.3], edge_length: 0.28}",
      "filter.time_step=4.5e-3"}}};
const std::array<std::string, 5> starts{"{kind: scramble, seed: 1}", "{kind: flatten_plane, axis: [1, 2, 3]}",
                                        "{kind: flatten_line, axis: [1, 2, 3]}",
                                        "{kind: inside_out, axis: [1, 2, 3]}", "{kind: flatten_point}"};

class FilteredRecovery : public testing::TestWithParam<std::string> {};

TEST_P(FilteredRecovery, EndsInShapeWithNothingInverted) {
  double worst = 0;
  for (const auto& [name, mesh, step] : bodies) {
    auto built = test::build(scene, {mesh, step, "bodies.body.start=" + GetParam()});
    auto& simulation = *built.simulation;
    EXPECT_GT(simulation.filter()->filtered_cells(), 0) << name;
    GlobalIndex inverted = 1;
    double error = 1;
    while (simulation.time() < 12 && !(inverted == 0 && error <= 1e-9)) {
      for (int i = 0; i < 50; ++i) {
        const double dt = simulation.suggested_time_step();
        simulation.next_event() < simulation.time() + dt ? simulation.step_to(simulation.next_event())
                                                         : simulation.step(dt);
      }
      inverted = simulation.inverted_points();
      error = rms_shape_error(simulation.mesh(), simulation.positions(), 0, simulation.mesh().total_nodes);
    }
    EXPECT_EQ(inverted, 0) << name;
    EXPECT_LE(error, 1e-9) << name;
    worst = std::max(worst, error);
  }
  test::verify("modal filter: filtered neo-Hookean ball, box and ellipsoid from " + GetParam() +
                   ": distance from their shapes [m]",
               "0", worst, "1e-9, nothing inverted");
}

INSTANTIATE_TEST_SUITE_P(Starts, FilteredRecovery, testing::ValuesIn(starts));

}  // namespace
}  // namespace evert
