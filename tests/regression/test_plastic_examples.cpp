// examples/taylor_bar, crushed_can and plastic_sphere, coarse: what flows stays within its limit and takes
// energy, also where it is hit ten times faster, or starts scrambled.
#include "evert/core/collective.hpp"
#include "evert/math/lower_triangle.hpp"
#include "evert/math/svd3.hpp"

#include <gtest/gtest.h>

#include "tests/support/examples.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace evert {
namespace {

/// Collective. The largest of all principal stretches of F_p and their inverses; infinity where one is not
/// positive.
double farthest_flow(const Simulation& simulation) {
  double farthest = 1;
  for (std::size_t e = 0; e < simulation.mesh().cells.size(); ++e) {
    const auto& cells = simulation.mesh().cells[e];
    const auto numbers = simulation.elastic().flow(e);
    const std::size_t row = simulation.elastic().flow_numbers(e);
    const auto points = static_cast<std::size_t>(quadrature_points(cells.type));
    const std::size_t of_point = row / points;  // a few more stand behind all points
    for (std::size_t c = 0; c < cells.global_ids.size(); ++c)
      for (std::size_t q = 0; q < points; ++q) {
        const double* l = &numbers[row * c + of_point * q];
        const Vec3d stretch = svd3(matrix(LowerTriangle<double>{l[0], l[1], l[2], l[3], l[4], l[5]})).sigma;
        farthest = std::max({farthest, stretch[0], stretch[2] > 0 ? 1 / stretch[2] : INFINITY});
      }
  }
  MPI_Allreduce(MPI_IN_PLACE, &farthest, 1, MPI_DOUBLE, MPI_MAX, simulation.mesh().comm);
  return farthest;
}

/// Runs to `end` [s], and looks at the flow on the way; until `controlled` [s] also at how far its goal is.
void run(Simulation& simulation, double end, double limit, const std::string& what, double controlled = 0) {
  constexpr int looks = 65;
  double work = 0, farthest = 1, distance = INFINITY;
  for (int look = 1; look <= looks; ++look) {
    test::run_until(simulation, end / looks * look);
    const auto now = simulation.measure();
    EXPECT_GE(now.plastic_work, work) << what;
    work = now.plastic_work;
    farthest = std::max(farthest, farthest_flow(simulation));
    if (simulation.time() > controlled) continue;
    EXPECT_LT(now.goal_distance, distance) << what;
    distance = now.goal_distance;
  }
  EXPECT_LE(farthest, limit * (1 + 1e-9)) << what;
  EXPECT_GT(farthest, 1.01) << what;
  test::verify(what + ": largest stretch of F_p or its inverse", "<= " + std::to_string(limit), farthest,
               "1e-9");
  if (controlled > 0) {
    test::verify(what + ": distance of log F_p from its goal over that at the start, under control", "< 0.01",
                 distance, "-");
    EXPECT_LT(distance, 0.01) << what;
  }
}

/// Collective. What flows freely from inverted states need not leave them: it flows to where it rests.
void print_inverted(const Simulation& simulation, const std::string& what) {
  test::verify(what + ": inverted points at the end", "-", static_cast<double>(simulation.inverted_points()),
               "-");
}

/// Collective.
void expect_none_inverted(const Simulation& simulation, const std::string& what) {
  const auto inverted = simulation.inverted_points();
  test::verify(what + ": inverted points at the end", "0", static_cast<double>(inverted), "0");
  EXPECT_EQ(inverted, 0) << what;
}

const std::vector<std::string> coarse_can{"bodies.can.mesh.quarter=6", "bodies.can.mesh.layers=6"};

std::vector<std::string> with(std::vector<std::string> some, std::initializer_list<const char*> more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

TEST(CrushedCan, StaysCrushed) {
  auto scene = test::build_example("crushed_can", coarse_can);
  run(*scene.simulation, 0.5, 10, "crushed can");
  expect_none_inverted(*scene.simulation, "crushed can");
  const auto x = test::gathered(scene.simulation->mesh(), scene.simulation->positions());
  double widest = 0, deepest = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    widest = std::max(widest, std::abs(x[i]));
    deepest = std::max(deepest, std::abs(x[i + 2]));
  }
  test::verify("crushed can: width over depth at the end", "< 0.5", widest / deepest, "-");
  EXPECT_LT(widest / deepest, 0.5);
}

TEST(CrushedCan, KeepsItsLimitTenTimesFaster) {
  auto scene = test::build_example(
      "crushed_can",
      with(
          coarse_can,
          {"obstacles.left.motion.keyframes=[[0, 0, 0, 0, 1, 0, 0, 0], [0.025, 0.35, 0, 0, 1, 0, 0, 0]]",
           "obstacles.right.motion.keyframes=[[0, 0, 0, 0, 1, 0, 0, 0], [0.025, -0.35, 0, 0, 1, 0, 0, 0]]"}));
  run(*scene.simulation, 0.05, 10, "can crushed ten times faster");
  expect_none_inverted(*scene.simulation, "can crushed ten times faster");
}

TEST(CrushedCan, KeepsItsLimitFromAScrambledStart) {
  auto scene = test::build_example(
      "crushed_can",
      with(coarse_can, {"bodies.can.start={kind: scramble, amplitude: 0.3}", "obstacles=null"}));
  EXPECT_GT(scene.simulation->inverted_points(), 0);
  run(*scene.simulation, 0.02, 10, "scrambled can");
  print_inverted(*scene.simulation, "scrambled can");
}

const std::vector<std::string> coarse_bar{"bodies.bar.mesh.quarter=2", "bodies.bar.mesh.rings=2",
                                          "bodies.bar.mesh.layers=18"};

TEST(TaylorBar, KeepsItsLimitTenTimesFaster) {
  auto scene = test::build_example(
      "taylor_bar", with(coarse_bar, {"bodies.bar.velocity=[0, -2270, 0]", "bodies.bar.plasticity.limit=8"}));
  run(*scene.simulation, 8e-6, 8, "Taylor bar ten times faster");
  print_inverted(*scene.simulation, "Taylor bar ten times faster");
}

TEST(TaylorBar, KeepsItsLimitFromAScrambledStart) {
  auto scene = test::build_example(
      "taylor_bar", with(coarse_bar, {"bodies.bar.start={kind: scramble, amplitude: 0.3}", "obstacles=null",
                                      "bodies.bar.plasticity.limit=8"}));
  EXPECT_GT(scene.simulation->inverted_points(), 0);
  run(*scene.simulation, 8e-6, 8, "scrambled Taylor bar");
  print_inverted(*scene.simulation, "scrambled Taylor bar");
}

/// Final length and radius of the bar [mm].
struct Bar {
  double length, radius;
};

Bar bar_after(const std::vector<std::string>& overrides) {
  auto scene = test::build_example("taylor_bar", overrides);
  test::run_until(*scene.simulation, 8e-5);
  const auto x = test::gathered(scene.simulation->mesh(), scene.simulation->positions());
  Bar bar{};
  for (std::size_t i = 0; i < x.size(); i += 3) {
    bar.length = std::max(bar.length, 1e3 * x[i + 1]);
    bar.radius = std::max(bar.radius, 1e3 * std::hypot(x[i], x[i + 2]));
  }
  return bar;
}

/// Limit of values at cells of 1/3, 1/4 and 1/6, as a + b hᵖ.
double fitted(double of_3, double of_4, double of_6) {
  const auto power = [](double p) {
    return std::array{std::pow(1.0 / 3, p), std::pow(0.25, p), std::pow(1.0 / 6, p)};
  };
  double low = 0.1, high = 6;  // the ratio of the differences grows with p
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const auto h = power(middle);
    ((h[0] - h[1]) / (h[1] - h[2]) < (of_3 - of_4) / (of_4 - of_6) ? low : high) = middle;
  }
  const auto h = power(low);
  return of_6 - (of_4 - of_6) / (h[1] - h[2]) * h[2];
}

/// Foulk et al. 2021, hexahedra converged: 7.22 mm; composite tetrahedra in Sierra/SM: 7.23 mm and 21.43 mm
/// (examples/taylor_bar/README.md).
TEST(TaylorBar, ComesToThePublishedShape) {
  if (size_of(PETSC_COMM_WORLD) > 1)
    GTEST_SKIP() << "shown on one rank; test_plasticity shows that ranks agree";
  std::vector<Bar> hexes;
  for (const char* n : {"3", "4", "6"})
    hexes.push_back(
        bar_after({std::string("bodies.bar.mesh.quarter=") + n, std::string("bodies.bar.mesh.rings=") + n,
                   std::string("bodies.bar.mesh.layers=") + std::to_string(9 * (n[0] - '0'))}));
  const double length = fitted(hexes[0].length, hexes[1].length, hexes[2].length);
  const double radius = fitted(hexes[0].radius, hexes[1].radius, hexes[2].radius);
  test::verify("Taylor bar, hex8, length on three meshes, fitted [mm]", "21.43", length, "5 %");
  test::verify("Taylor bar, hex8, radius at the wall on three meshes, fitted [mm]", "7.22", radius, "5 %");
  test::verify("Taylor bar, hex8, radius at the wall, finest of the three [mm]", "7.22", hexes[2].radius,
               "-");
  EXPECT_NEAR(length, 21.43, 0.05 * 21.43);
  EXPECT_NEAR(radius, 7.22, 0.05 * 7.22);
  EXPECT_GT(hexes[1].radius, hexes[0].radius);
  EXPECT_GT(hexes[2].radius, hexes[1].radius);
  const auto tets = bar_after(
      {"bodies.bar.mesh={generate: cylinder, radius: 3.2e-3, length: 32.4e-3, edge_length: 1.2e-3}"});
  test::verify("Taylor bar, tet4, length [mm]", "21.43", tets.length, "5 %");
  test::verify("Taylor bar, tet4, radius at the wall [mm]", "7.22", tets.radius, "5 %");
  EXPECT_NEAR(tets.length, 21.43, 0.05 * 21.43);
  EXPECT_NEAR(tets.radius, 7.22, 0.05 * 7.22);
  // Hexahedra cut into tetrahedra lock, which those of a body-centred lattice hardly do.
  const auto locked =
      bar_after({"bodies.bar.mesh.quarter=4", "bodies.bar.mesh.rings=4", "bodies.bar.mesh.layers=36",
                 "bodies.bar.mesh.cell=tet6", "bodies.bar.mean_dilatation=false"});
  test::verify("Taylor bar, tet4 of hexahedra, radius at the wall [mm]: they lock", "-", locked.radius, "-");
  EXPECT_LT(locked.radius, 0.95 * hexes[1].radius);
}

const std::vector<std::string> coarse_sphere{"bodies.sphere.mesh.edge_length=0.1"};

/// RMS distance of the nodes from the disk [m], rigid motion removed; of all ranks.
double distance_from_disk(const Simulation& simulation) {
  const auto& mesh = simulation.mesh();
  NodeField rest(mesh);
  for (std::size_t i = 0; i < rest.owned().size(); ++i) rest.owned()[i] = mesh.rest_positions[i / 3][i % 3];
  const auto x = test::gathered(mesh, simulation.positions()), at_rest = test::gathered(mesh, rest);
  const std::size_t nodes = x.size() / 3;
  const auto mean = [&](const std::vector<double>& of, std::size_t k) {
    double sum = 0;
    for (std::size_t i = 0; i < nodes; ++i) sum += of[3 * i + k];
    return sum / static_cast<double>(nodes);
  };
  const Vec3d here{mean(x, 0), mean(x, 1), mean(x, 2)},
      there{mean(at_rest, 0), mean(at_rest, 1), mean(at_rest, 2)};
  const auto disk = [&](std::size_t i) {
    const Vec3d d = Vec3d{at_rest[3 * i], at_rest[3 * i + 1], at_rest[3 * i + 2]} - there;
    return Vec3d{0.4 * d[0], d[1] / std::sqrt(0.4), d[2] / std::sqrt(0.4)};
  };
  const auto now = [&](std::size_t i) { return Vec3d{x[3 * i], x[3 * i + 1], x[3 * i + 2]} - here; };
  Mat3d moment{};
  for (std::size_t i = 0; i < nodes; ++i) moment += outer(now(i), disk(i));
  const auto svd = svd3(moment);
  const Mat3d turn = times_transpose(svd.u, svd.v);
  double sum = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const Vec3d left = now(i) - turn * disk(i);
    sum += dot(left, left);
  }
  return std::sqrt(sum / static_cast<double>(nodes));
}

TEST(PlasticSphere, KeepsTheMarksOfTheTeeth) {
  auto free =
      test::build_example("plastic_sphere", with(coarse_sphere, {"obstacles=null", "gravity=[0, 0, 0]"}));
  run(*free.simulation, 1.3, 6, "plastic sphere without gears", 0.3);
  expect_none_inverted(*free.simulation, "plastic sphere without gears");
  EXPECT_LT(free.simulation->measure().goal_distance, 0.01);
  const double without = distance_from_disk(*free.simulation);

  auto drawn = test::build_example("plastic_sphere", coarse_sphere);
  run(*drawn.simulation, 1.3, 6, "plastic sphere in gears", 0.3);
  expect_none_inverted(*drawn.simulation, "plastic sphere in gears");
  const double marks = distance_from_disk(*drawn.simulation) / without;
  test::verify("plastic sphere: RMS distance from the disk with gears over that without", "> 10", marks, "-");
  EXPECT_GT(marks, 10);
}

TEST(PlasticSphere, KeepsItsLimitInGearsTenTimesFaster) {
  auto scene = test::build_example(
      "plastic_sphere", with(coarse_sphere, {"obstacles.left.motion.angular_velocity=[0, 0, -20]",
                                             "obstacles.right.motion.angular_velocity=[0, 0, 20]"}));
  run(*scene.simulation, 1.3, 6, "plastic sphere in gears ten times faster", 0.3);
  expect_none_inverted(*scene.simulation, "plastic sphere in gears ten times faster");
}

/// As a disk, after 0.3 s, it is where the example has it, at 30 m/s instead of 3 m/s.
TEST(PlasticSphere, KeepsItsLimitWhenItHitsTheGearsTenTimesFaster) {
  auto scene = test::build_example("plastic_sphere",
                                   with(coarse_sphere, {"bodies.sphere.transform.translate=[0, 10.45, 0]",
                                                        "bodies.sphere.velocity=[0, -27, 0]"}));
  run(*scene.simulation, 1.3, 6, "plastic sphere hitting gears ten times faster", 0.3);
  expect_none_inverted(*scene.simulation, "plastic sphere hitting gears ten times faster");
}

TEST(PlasticSphere, ReachesItsGoalFromAScrambledStart) {
  auto scene = test::build_example(
      "plastic_sphere",
      with(coarse_sphere, {"bodies.sphere.start={kind: scramble}", "obstacles=null", "gravity=[0, 0, 0]",
                           "bodies.sphere.plasticity.goal.until=1.3"}));
  EXPECT_GT(scene.simulation->inverted_points(), 0);
  run(*scene.simulation, 1.3, 6, "scrambled plastic sphere", 0.6);
  expect_none_inverted(*scene.simulation, "scrambled plastic sphere");
}

TEST(PlasticSphere, KeepsItsLimitInGearsFromAScrambledStart) {
  auto scene =
      test::build_example("plastic_sphere", with(coarse_sphere, {"bodies.sphere.start={kind: scramble}"}));
  EXPECT_GT(scene.simulation->inverted_points(), 0);
  run(*scene.simulation, 1.3, 6, "scrambled plastic sphere in gears", 0.3);
  print_inverted(*scene.simulation, "scrambled plastic sphere in gears");
}

}  // namespace
}  // namespace evert
