// Cantilevers against Timoshenko's theory, and tetrahedra that lock.
#include "evert/bench/linear_beam.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/verify.hpp"
#include <cmath>
#include <string>

namespace evert {
namespace {

using bench::Beam;
using bench::BeamAnswer;

BeamAnswer answer_of(BoxCells cells, int across, bool quadratic, const Beam& beam = {},
                     bool frequency = true) {
  return bench::solve_beam(PETSC_COMM_WORLD, bench::beam_mesh(beam, cells, across, quadratic), beam,
                           frequency);
}

std::string text(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return buffer.data();
}

void expect_near(const std::string& what, double expected, double found, double tolerance) {
  test::verify(what.c_str(), text(expected).c_str(), found, (text(100 * tolerance) + " %").c_str());
  EXPECT_NEAR(found, expected, tolerance * expected) << what;
}

TEST(Beam, TimoshenkoIsEulerWhereSlender) {
  const Beam slender{.length = 1, .height = 1e-3};
  const double euler =
      3.5160152685 * std::sqrt(slender.youngs_modulus * 1e-6 / 12 / slender.density) / (2 * 3.14159265359);
  EXPECT_NEAR(bench::timoshenko(slender).frequency, euler, 1e-5 * euler);
}

struct Refined {
  const char* name;
  BoxCells cells;
  int across;
  bool quadratic;
};

class RefinedBeam : public testing::TestWithParam<Refined> {};

TEST_P(RefinedBeam, BendsAndVibratesAsTimoshenkoSays) {
  const auto& [name, cells, across, quadratic] = GetParam();
  const auto theory = bench::timoshenko({});
  const auto found = answer_of(cells, across, quadratic);
  expect_near(std::string("beam, ") + name + ", tip deflection [m]", theory.tip_deflection,
              found.tip_deflection, 0.01);
  expect_near(std::string("beam, ") + name + ", first frequency [Hz]", theory.frequency, found.frequency,
              0.01);
  const auto coarser = answer_of(cells, across / 2, quadratic, {}, false);
  EXPECT_LT(coarser.tip_deflection, found.tip_deflection) << "meshes are too stiff, and less so when refined";
}

INSTANTIATE_TEST_SUITE_P(Refined, RefinedBeam,
                         testing::Values(Refined{"hex8", BoxCells::hex8, 8, false},
                                         Refined{"tet10", BoxCells::tet6, 4, true}),
                         [](const auto& choice) { return std::string(choice.param.name); });

/// The same beam as a scene.
const std::string cantilever = R"(
name: cantilever
end_time: 10
gravity: [0, 0, -0.1]
bodies:
  beam:
    mesh: {generate: box, min: [0, -0.05, -0.05], max: [1, 0.05, 0.05], cells: [20, 2, 2], cell: hex8}
    density: 1000
    material: {model: rotated_linear, youngs_modulus: 1.0e6, poissons_ratio: 0.3}
constraints:
  - {body: beam, node_set: x_min, fixed: true, axes: [true, false, false]}   # free to become wider and narrower
  - {body: beam, box: {min: [0, -1, 0], max: [0, 1, 0]}, fixed: true, axes: [false, false, true]}
  - {body: beam, box: {min: [0, 0, -1], max: [0, 0, 1]}, fixed: true, axes: [false, true, false]}
)";

double mean_sag(const Simulation& simulation) {
  std::array<double, 2> sums{};
  for (LocalIndex node = 0; node < simulation.mesh().owned_nodes; ++node) {
    if (simulation.mesh().rest_positions[static_cast<std::size_t>(node)][0] < 1 - 1e-6) continue;
    sums[0] += simulation.mesh().rest_positions[static_cast<std::size_t>(node)][2] -
               simulation.positions().owned()[3 * static_cast<std::size_t>(node) + 2];
    sums[1] += 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sums[0] / sums[1];
}

/// Critically damped at its first frequency it creeps to where it stays: after 1.7 periods e^(-10.7) · 11.7 =
/// 3e-4 of the way is left.
double sag_at_rest(const std::vector<std::string>& overrides, double frequency) {
  auto all = overrides;
  all.push_back("bodies.beam.damping={model: none, mass_ratio: 1, frequency: " + text(frequency) + "}");
  auto scene = test::build(cantilever, all);
  while (scene.simulation->time() < 1.7 / frequency)
    scene.simulation->step(scene.simulation->suggested_time_step());
  return mean_sag(*scene.simulation);
}

/// Tens of thousands of steps: other tests hold several ranks to what one does in a few.
bool several_ranks() {
  int ranks = 0;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  return ranks > 1;
}

TEST(BeamInMotion, ComesToRestWhereTheEquationsSay) {
  if (several_ranks()) GTEST_SKIP() << "on one rank only, to save time";
  const auto theory = bench::timoshenko({});
  const auto equations = answer_of(BoxCells::hex8, 2, false);
  expect_near("beam, hex8 2 across, tip at rest by damped motion against the linear equations [m]",
              equations.tip_deflection, sag_at_rest({}, equations.frequency), 1e-3);
  expect_near("beam, tet10, tip at rest by damped motion [m]", theory.tip_deflection,
              sag_at_rest({"bodies.beam.mesh.cell=tet6", "bodies.beam.order=2"}, theory.frequency), 0.01);
}

/// Under its weight from rest the tip goes down and back up in a period; it is slowest at the turns.
TEST(BeamInMotion, VibratesWithTheFrequencyOfTheEquations) {
  if (several_ranks()) GTEST_SKIP() << "on one rank only, to save time";
  auto scene = test::build(cantilever);
  auto& simulation = *scene.simulation;
  const auto equations = answer_of(BoxCells::hex8, 2, false);
  // Sag − its mean crosses zero at 1/4 and 3/4 of the period, from whatever higher vibrations add to.
  const double middle = equations.tip_deflection;
  std::vector<double> crossings;
  double before = -middle, time_before = 0;
  while (crossings.size() < 4) {
    simulation.step(simulation.suggested_time_step());
    const double now = mean_sag(simulation) - middle;
    if ((now > 0) != (before > 0))
      crossings.push_back(time_before + (simulation.time() - time_before) * before / (before - now));
    before = now;
    time_before = simulation.time();
  }
  const double period = 0.5 * (crossings[2] - crossings[0] + crossings[3] - crossings[1]);
  expect_near("beam, hex8 2 across, frequency in motion against that of the equations [Hz]",
              equations.frequency, 1 / period, 5e-3);
}

/// Linear tetrahedra cannot bend without a change of volume: near ν = 0.5 they hardly bend at all.
TEST(Locking, OfTet4IsMeasuredAndTet10HasLittle) {
  double less = 1;
  for (const double nu : {0.3, 0.45, 0.49, 0.499}) {
    const Beam beam{.poissons_ratio = nu};
    const double theory = bench::timoshenko(beam).tip_deflection;
    const double tet4 = answer_of(BoxCells::tet6, 4, false, beam, false).tip_deflection / theory;
    const double tet10 = answer_of(BoxCells::tet6, 4, true, beam, false).tip_deflection / theory;
    test::verify(("beam, tet4, share of the deflection at nu " + text(nu)).c_str(), "less and less", tet4,
                 "-");
    EXPECT_LT(tet4, less) << nu;
    less = tet4;
    expect_near("beam, tet10, share of the deflection at nu " + text(nu), 1, tet10, 0.01);
  }
  EXPECT_LT(less, 0.5) << "if it does not lock, docs/elements.md is wrong";
}

}  // namespace
}  // namespace evert
