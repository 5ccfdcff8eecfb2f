// Real meshes dropped on the ground: finite, and what the world gave is what they have.
#include <gtest/gtest.h>

#include "tests/support/ranks.hpp"
#include "tests/support/scenes.hpp"
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace evert {
namespace {

/// Collective. Values of `field` that are NaN or infinite, over all ranks.
long not_finite(const NodeField& field) {
  long count = 0;
  for (const double value : field.owned()) count += std::isfinite(value) ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_LONG, MPI_SUM, PETSC_COMM_WORLD);
  return count;
}

/// On rank 0: a row of the table in docs/design/time-stepping.md.
void report(const std::string& mesh, const Simulation& simulation, double wall_seconds, double imbalance) {
  int rank = 0, ranks = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  if (rank == 0)
    std::printf("| %s | %d | %.2g | %lld | %.0f | %.1e |\n", mesh.c_str(), ranks, simulation.time(),
                static_cast<long long>(simulation.steps()), wall_seconds, imbalance);
}

/// So soft that it collapses under its weight. Steps in which slivers may flip at once: what they do there is
/// of no interest, and most of them do nothing else.
const std::string drop = R"(
name: drop
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  body:
    mesh: {file: mesh.msh}
    transform: {fit: 1, translate: [0, 0.7, 0]}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e3, poissons_ratio: 0.3}
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.3}
integrator: {max_strain_increment: 0.3}
)";

class RealMesh : public testing::TestWithParam<const char*> {};

/// The large ones for minutes with EVERT_ALL_MESHES=1, else until they have hit the ground.
TEST_P(RealMesh, DropsForASecondAndKeepsTheBalance) {
  if (test::shown_on_one_rank() && GetParam() != std::string("dolphin5K.msh"))
    GTEST_SKIP() << "shown on one rank";
  const bool whole = std::string(GetParam()) == "liver.msh" || std::getenv("EVERT_ALL_MESHES") != nullptr;
  const char* folder = std::getenv("EVERT_SHARED_MESHES");
  const auto path = std::filesystem::path(folder == nullptr ? "" : folder) / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  ASSERT_EQ(PetscOptionsSetValue(nullptr, "-damping_ksp_rtol", "1e-7"), 0);  // for a balance of 1e-9
  auto scene = test::build(drop, {"bodies.body.mesh.file=" + path.string()});
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure();
  const auto clock = std::chrono::steady_clock::now();
  test::run_until(simulation, whole ? 1.0 : 0.26);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - clock;
  EXPECT_EQ(not_finite(simulation.positions()), 0);
  EXPECT_EQ(not_finite(simulation.velocities()), 0);
  const auto now = simulation.measure();
  EXPECT_GT(now.contact_impulse[1], 0) << "it must have hit the ground";
  const auto received = now.gravity_impulse + now.contact_impulse + now.constraint_impulse;
  const double imbalance = norm(now.momentum - start.momentum - received) / norm(now.gravity_impulse);
  EXPECT_LE(imbalance, 1e-8);
  report(GetParam(), simulation, wall.count(), imbalance);
}

INSTANTIATE_TEST_SUITE_P(Shared, RealMesh,
                         testing::Values("Armadillo13K.msh", "bunny.mesh", "dolphin5K.msh", "liver.msh"));

}  // namespace
}  // namespace evert
