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

/// Steps until it fails, at most `most`.
std::string error_of_steps(Simulation& simulation, double dt, int most) {
  return simulation_error_of([&] {
    for (int step = 0; step < most; ++step) simulation.step(dt);
  });
}

/// The same on every rank as on the first.
bool is_on_all_ranks(std::string text) {
  const auto own = text;
  auto size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, PETSC_COMM_WORLD);
  int same = text == own ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  return same != 0;
}

const std::string rings = "bodies.cube.start={kind: scramble, amplitude: 1e-3}";

double auto_step() {
  return test::build(scene, {"integrator.time_step=auto", rings}).simulation->suggested_time_step();
}

TEST(Simulation, StopsStepsAboveTheBoundLongBeforeAnythingOverflows) {
  const double dt = auto_step();
  for (const std::string method : {"newmark", "verlet", "symplectic_euler"})
    for (const double factor : {3.0, 5.0}) {
      const auto built = test::build(scene, {"integrator.method=" + method, rings});
      auto& simulation = *built.simulation;
      const auto error = error_of_steps(simulation, factor * dt, 100);
      for (const char* part : {"the motion has blown up: velocities turned round in each of the last",
                               "first to look at is node", "of element", "of 'cube' on rank",
                               "times the longest that is sure to be stable at rest, because of element",
                               "a well-shaped tetrahedron", "try an integrator.time_step of"})
        EXPECT_NE(error.find(part), std::string::npos)
            << method << ": says nothing of '" << part << "': " << error;
      EXPECT_TRUE(is_on_all_ranks(error));
      EXPECT_LT(simulation.steps(), 20);
    }
}

TEST(Simulation, StopsEnergyFromNowhere) {
  // A spin that is symmetric stirs the fastest vibrations by rounding only; others grow first, and do not
  // turn round.
  const auto built = test::build(scene, {"bodies.cube.spin=[1, 2, 3]"});
  const auto error = error_of_steps(*built.simulation, 2 * auto_step(), 200);
  EXPECT_NE(error.find("the motion has blown up"), std::string::npos) << error;
  EXPECT_NE(error.find("try an integrator.time_step of"), std::string::npos) << error;
  EXPECT_EQ(built.simulation->steps() % EnergyWatch::interval, 0) << error;
}

TEST(Simulation, LetsBodiesFallWithoutEnd) {
  for (const char* velocity : {"[0, 0, 0]", "[0, 0.1, 0]"}) {
    const auto built =
        test::build(scene, {"gravity=[0, -1e6, 0]", std::string("bodies.cube.velocity=") + velocity});
    EXPECT_EQ(error_of_steps(*built.simulation, 1e-3, 500), "");
  }
}

TEST(Simulation, SuspectsWhatBeginsToExplodeAndNothingElse) {
  const auto built = test::build(scene, {"integrator.method=verlet", rings});
  auto& simulation = *built.simulation;
  for (int step = 0; step < 200; ++step) {
    simulation.step(1e-3);
    EXPECT_FALSE(simulation.suspicious()) << step;
  }
  int suspicious = 0;
  const double dt = 2 * auto_step();
  const auto error = simulation_error_of([&] {
    for (int step = 0; step < 100; ++step) {
      simulation.step(dt);
      suspicious += simulation.suspicious() ? 1 : 0;
    }
  });
  EXPECT_NE(error, "");
  EXPECT_GT(suspicious, 0);
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
