// Real meshes dropped on the ground: finite, and what the world gave is what they have.
#include <gtest/gtest.h>

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

/// On rank 0: what the run took.
void report(const std::string& mesh, const Simulation& simulation, double wall_seconds, double imbalance) {
  int rank = 0, ranks = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  if (rank == 0)
    std::printf("%s on %d ranks: %lld steps, %.0f s, momentum balanced to %.1e\n", mesh.c_str(), ranks,
                static_cast<long long>(simulation.steps()), wall_seconds, imbalance);
}

class RealMesh : public testing::TestWithParam<const char*> {};

TEST_P(RealMesh, DropsForASecondAndKeepsTheBalance) {
  const bool small = std::string(GetParam()) == "liver.msh";
  if (!small && std::getenv("EVERT_ALL_MESHES") == nullptr)
    GTEST_SKIP() << "takes minutes: EVERT_ALL_MESHES=1 runs it";
  const char* folder = std::getenv("EVERT_SHARED_MESHES");
  const auto path = std::filesystem::path(folder == nullptr ? "" : folder) / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  auto scene = test::build(R"(
name: drop
end_time: 1
gravity: [0, -9.81, 0]
bodies:
  body:
    mesh: {file: mesh.msh}
    transform: {fit: 1, translate: [0, 0.7, 0]}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1.0e3, poissons_ratio: 0.4}
    damping: {model: rotated, stiffness_proportional: 1.0e-3}
obstacles:
  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.3}
)",
                           {"bodies.body.mesh.file=" + path.string()});
  auto& simulation = *scene.simulation;
  const auto start = simulation.measure();
  const auto clock = std::chrono::steady_clock::now();
  while (simulation.time() < 1.0) {
    const double left = 1.0 - simulation.time();
    const double steps = std::ceil(left / simulation.suggested_time_step() - 1e-9);
    steps <= 1 ? simulation.step_to(1.0) : simulation.step(left / steps);
  }
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
