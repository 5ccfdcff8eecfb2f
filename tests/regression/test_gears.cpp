// examples/hex_gears and figure_gears, coarse: drawn through the gears, and whole again, also where the gears
// are worse.
#include "evert/sim/shape_error.hpp"

#include <gtest/gtest.h>

#include "tests/support/examples.hpp"
#include "tests/support/ranks.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

namespace evert {
namespace {

struct Body {
  const char* example;
  double size;  // [m]
  double end;   // [s] when it is at rest again
  std::vector<std::string> coarse;
};

struct Gears {
  const char* name;
  std::vector<std::string> overrides;
};

using Case = std::tuple<Body, Gears>;

std::string name_of(const Case& c) { return std::string(std::get<0>(c).example) + "_" + std::get<1>(c).name; }

void PrintTo(const Case& c, std::ostream* out) { *out << name_of(c); }

class Drawn : public testing::TestWithParam<Case> {};

TEST_P(Drawn, ThroughGearsItRecovers) {
  if (test::shown_on_one_rank() && name_of(GetParam()) != "hex_gears_as_they_are")
    GTEST_SKIP() << "shown on one rank";
  const auto& [body, gears] = GetParam();
  auto overrides = body.coarse;
  overrides.insert(overrides.end(), gears.overrides.begin(), gears.overrides.end());
  auto scene = test::build_example(body.example, overrides);
  auto& simulation = *scene.simulation;
  const auto& mesh = simulation.mesh();
  double most_inverted = 0;
  while (simulation.time() < body.end) {
    simulation.step_to(std::min(body.end, simulation.time() + simulation.suggested_time_step()));
    most_inverted = std::max(most_inverted, static_cast<double>(simulation.inverted_points()));
  }
  const auto points = static_cast<double>(quadrature_points(mesh.cells.front().type) * mesh.total_cells);
  const double error = rms_shape_error(mesh, simulation.positions(), 0, mesh.total_nodes) / body.size;
  const auto what = name_of(GetParam());
  test::verify(what + ": share of inverted points at most", "> 0.02", most_inverted / points, "-");
  test::verify(what + ": inverted points at the end", "0", static_cast<double>(simulation.inverted_points()),
               "0");
  test::verify(what + ": RMS distance from its shape at the end over its size", "< 0.01", error, "-");
  EXPECT_GT(most_inverted / points, 0.02);
  EXPECT_EQ(simulation.inverted_points(), 0);
  EXPECT_LT(error, 0.01);
}

/// Gears that overlap are left out for the figure, which may end in another equilibrium than its shape: see
/// examples/figure_gears/README.md.
std::vector<Case> cases() {
  const Body cross{"hex_gears", 0.9, 3.8, {"bodies.cross.mesh.cells=[9, 9, 9]", "bodies.cross.mesh.cross=3"}};
  const Body figure{"figure_gears",
                    1.6,
                    6,
                    // stouter, so that coarse cells fit into its arms
                    {"bodies.figure.mesh={generate: union, edge_length: 0.08, "
                     "of: [{shape: figure, height: 1.6, grow: 0.01}]}"}};
  const Gears as_they_are{"as_they_are", {}};
  const Gears closer{"closer_by_a_fifth",
                     {"obstacles.left.center=[-0.32, 1.5, 0]", "obstacles.right.center=[0.32, 1.5, 0]"}};
  const Gears faster{"ten_times_faster",
                     {"obstacles.left.motion.angular_velocity=[0, 0, -20]",
                      "obstacles.right.motion.angular_velocity=[0, 0, 20]", "obstacles.left.until=0.5",
                      "obstacles.right.until=0.5"}};
  const Gears rougher{"friction_5", {"obstacles.left.friction=5", "obstacles.right.friction=5"}};
  return {{cross, as_they_are},  {cross, closer},  {cross, faster},  {cross, rougher},
          {figure, as_they_are}, {figure, faster}, {figure, rougher}};
}

INSTANTIATE_TEST_SUITE_P(All, Drawn, testing::ValuesIn(cases()),
                         [](const auto& drawn) { return name_of(drawn.param); });

}  // namespace
}  // namespace evert
