#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include <cmath>

/// What a step promises: that all ranks learn what one of them knows.
namespace evert {
namespace {

constexpr auto scene = R"(
name: free
end_time: 1
bodies:
  cube:
    mesh: {generate: box, size: [1, 1, 1], cells: [4, 2, 2], cell: tet6}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
integrator: {time_step: 1e-3}
)";

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

bool on_last_rank() { return rank_of(PETSC_COMM_WORLD) + 1 == size_of(PETSC_COMM_WORLD); }

std::string simulation_error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

/// One component of the last node of the last rank becomes `value`; everything else stays.
std::string error_of_state(Simulation& simulation, bool position, double value) {
  const auto x = simulation.positions().owned();
  const auto v = simulation.velocities().owned();
  std::vector<double> positions(x.begin(), x.end());
  std::vector<double> velocities(v.begin(), v.end());
  if (on_last_rank()) (position ? positions : velocities).back() = value;
  return simulation_error_of([&] {
    simulation.restore({positions, velocities, simulation.node_state().velocity_changes},
                       simulation.state_scalars());
  });
}

TEST(Simulation, AllRanksLearnOfOneNodeThatIsNotFinite) {
  for (const bool position : {true, false})
    for (const double value : {nan, -nan, infinity, -infinity}) {
      const auto built = test::build(scene);
      const auto error = error_of_state(*built.simulation, position, value);
      EXPECT_NE(error.find("1 of 45 nodes"), std::string::npos) << error;
    }
}

TEST(Simulation, NoNodeIsFasterThanLight) {
  const auto built = test::build(scene);
  EXPECT_EQ(error_of_state(*built.simulation, false, -299792458.0), "");
  EXPECT_NE(error_of_state(*built.simulation, false, -299792459.0), "");
}

TEST(Simulation, StopsWhereTheStepIsLostInTheTime) {
  const auto built = test::build(scene);
  built.simulation->step(1e-3);
  for (const double dt : {1e-30, 0.0, -1e-3, nan}) {
    const auto error = simulation_error_of([&] { built.simulation->step(dt); });
    EXPECT_NE(error.find("t = 0.001 s, step 1"), std::string::npos) << dt << ": " << error;
  }
}

/// A definition made by hand, which no scene has checked.
TEST(Simulation, RefusesConsistentMassesWithContactOrAtRest) {
  const auto made_with = [](const std::function<void(SimulationDefinition&)>& change) {
    SimulationDefinition definition;
    definition.properties = {{1000, NeoHookean{.lame = Lame::from_young_poisson(1e5, 0.3)}, {}}};
    definition.mass = MassForm::consistent;
    change(definition);
    auto mesh = distribute(PETSC_COMM_WORLD, generate_box({1, 1, 1}, {4, 2, 2}, BoxCells::tet6));
    for (LocalIndex i = 0; i < mesh.owned_nodes; ++i)
      definition.initial_positions.push_back(mesh.rest_positions[static_cast<std::size_t>(i)]);
    const Simulation simulation(std::move(mesh), std::move(definition));
  };
  EXPECT_NO_THROW(made_with([](SimulationDefinition&) {}));
  EXPECT_THROW(made_with([](SimulationDefinition& definition) {
                 definition.obstacles.push_back(std::make_unique<Obstacle>(
                     "ground", 0.1, std::make_unique<HalfSpace>(Vec3d{}, Vec3d{0, 1, 0}),
                     std::make_unique<UniformMotion>(RigidState{})));
               }),
               UserError);
  EXPECT_THROW(
      made_with([](SimulationDefinition& definition) { definition.method = IntegrationMethod::quasistatic; }),
      UserError);
}

TEST(Simulation, AllRanksLearnThatOneWantsToStop) {
  const auto built = test::build(scene);
  EXPECT_FALSE(built.simulation->step(1e-3).stop_requested);
  if (on_last_rank()) built.simulation->request_stop();
  EXPECT_TRUE(built.simulation->step(1e-3).stop_requested);
}

TEST(Simulation, PhasesAddUpToNoMoreThanTheWallTime) {
  const auto before = phase_seconds();
  const double begin = MPI_Wtime();
  const auto built =
      test::build(scene, {"bodies.cube.damping={model: rotated, stiffness_proportional: 0.01}"});
  for (int step = 0; step < 5; ++step) built.simulation->step(1e-3);
  static_cast<void>(built.simulation->measure());
  const double wall = MPI_Wtime() - begin;
  double sum = 0;
  std::array<double, phase_count> spent{};
  for (std::size_t phase = 0; phase < phase_count; ++phase)
    sum += spent[phase] = phase_seconds()[phase] - before[phase];
  EXPECT_LE(sum, wall);
  for (const auto phase : {Phase::setup, Phase::force, Phase::damping_apply, Phase::damping_solve})
    EXPECT_GT(spent[static_cast<std::size_t>(phase)], 0) << name_of(phase);
  EXPECT_EQ(spent[static_cast<std::size_t>(Phase::halo)] > 0, size_of(PETSC_COMM_WORLD) > 1);
}

}  // namespace
}  // namespace evert
