// Meshes with bad elements: their true limits and how near the bounds come.  PHYSICS 9, "Reference meshes"
#include "evert/core/formatted.hpp"
#include "evert/mesh/bad_meshes.hpp"

#include <gtest/gtest.h>

#include "all_bounds.hpp"
#include "tests/support/shared_meshes.hpp"
#include "tests/support/verify.hpp"
#include <algorithm>
#include <cmath>
#include <vector>

namespace evert::test {
namespace {

struct Reference {
  std::string name;
  double density;                  // [kg/m^3]
  double true_limit = 0;           // [s]; 0: not known
  double eq9 = 0, eq8 = 0;         // true limit over that of the bound; 0: not known
  double collatz_wielandt = 0.95;  // at least this share of the true limit
};

class ReferenceLimits : public testing::TestWithParam<Reference> {};

TEST_P(ReferenceLimits, AreWhatAPrototypeFound) {
  const auto& reference = GetParam();
  const auto path = shared_mesh(reference.name);
  if (!path) GTEST_SKIP() << reference.name << " is not there: set EVERT_SHARED_MESHES to its folder";
  const auto mesh = distributed(*path);
  const ElasticForces elastic(
      mesh, std::vector{ElasticProperties{
                reference.density, RotatedLinear{.lame = Lame::from_young_poisson(1e4, 0.3)}, {}}});
  auto x = at_rest(mesh);
  const auto bounds = all_bounds(mesh, elastic, x);
  const auto ratio = [&](double bound) { return std::sqrt(bound / bounds.truth); };
  const double limit = step_limit(bounds.truth);
  // The step that `time_step: auto` starts from.
  double automatic = elastic.stable_step(x).undamped;
  MPI_Allreduce(MPI_IN_PLACE, &automatic, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);

  EXPECT_GE(ratio(bounds.collatz_wielandt), 1 - 1e-9);
  EXPECT_LE(ratio(bounds.collatz_wielandt), 1 / reference.collatz_wielandt);
  EXPECT_GE(ratio(bounds.eq9), 1 - 1e-9);
  EXPECT_GE(ratio(bounds.eq8_upper), 1 - 1e-9);
  EXPECT_LE(ratio(bounds.lanczos), 1 + 1e-9);
  EXPECT_LE(automatic, limit * (1 + 1e-9));
  EXPECT_GE(automatic, 0.87 * limit);
  verify(reference.name + ": Collatz-Wielandt step over the true one", "1",
         1 / ratio(bounds.collatz_wielandt), formatted("%g to 1", reference.collatz_wielandt));
  verify(reference.name + ": 20 Lanczos steps, step over the true one", "1", 1 / ratio(bounds.lanczos),
         ">= 1");
  verify(reference.name + ": element bound of `auto`, step over the true one", "1", automatic / limit,
         "0.87 to 1");
  if (reference.true_limit > 0) {
    EXPECT_NEAR(limit, reference.true_limit, 5e-3 * reference.true_limit);
    verify(reference.name + ": true limit of the step [ms]", formatted("%g", 1e3 * reference.true_limit),
           1e3 * limit, "0.5 %");
  }
  if (reference.eq9 > 0) {
    EXPECT_NEAR(ratio(bounds.eq9), reference.eq9, 0.01 * reference.eq9);
    verify(reference.name + ": true step over that of eq. (9)", formatted("%g", reference.eq9),
           ratio(bounds.eq9), "1 %");
  }
  if (reference.eq8 > 0) {
    EXPECT_NEAR(ratio(bounds.eq8_upper), reference.eq8, 0.01 * reference.eq8);
    verify(reference.name + ": true step over that of eq. (8)", formatted("%g", reference.eq8),
           ratio(bounds.eq8_upper), "1 %");
  }
}

// PHYSICS 9 has 1.79 and 5.8 for a cut cube of the same true limit. For the shared file the closed form of
// eq. (9), evaluated by a program of its own, gives 0.2727 ms and so 1.686.
//
// mat40x40 is a thin mat of good elements. What the norms of blocks leave out, that their directions
// differ, costs most there: ρ(N) itself, after 300 iterations, is at 0.9446 of the true limit.
INSTANTIATE_TEST_SUITE_P(All, ReferenceLimits,
                         testing::Values(Reference{"wedge_stack.msh", 0.05, 0.1355e-3, 1.89, 1.49},
                                         Reference{"cut_cube.msh", 0.06, 0.4598e-3, 1.686},
                                         Reference{"ball404.msh", 1000, 3.791e-3},
                                         Reference{"ball20k.msh", 1000, 0.5117e-3, 60.8, 6.46},
                                         Reference{"liver.msh", 1000}, Reference{"torus.msh", 1000},
                                         Reference{"octopus-low.mesh", 1000},
                                         Reference{"mat40x40.msh", 1000, 0, 0, 0, 0.93},
                                         Reference{"dolphin5K.msh", 1000}, Reference{"bunny.mesh", 1000},
                                         Reference{"Armadillo13K.msh", 1000}),
                         [](const auto& test) {
                           auto name = test.param.name;
                           std::ranges::replace_if(
                               name, [](char c) { return c == '.' || c == '-'; }, '_');
                           return name;
                         });

struct Generated {
  const char* name;
  Mesh mesh;
  double density;     // [kg/m^3]
  double true_limit;  // [s]; 0: not known
};

std::vector<Generated> generated_meshes() {
  return {{"generated wedge_stack", generate_wedge_stack({}), 0.05, 0.1355e-3},
          {"generated cut_cube", generate_cut_cube({}), 0.06, 0.4598e-3},
          {"generated sliver_ball", generate_sliver_ball({.radius = 1, .edge_length = 0.2}), 1000, 0}};
}

TEST(ReferenceLimits, OfGeneratedMeshesAreThoseOfThePrototype) {
  for (const auto& [name, whole, density, true_limit] : generated_meshes()) {
    const auto mesh = distribute(PETSC_COMM_WORLD, whole);
    const ElasticForces elastic(
        mesh, std::vector{
                  ElasticProperties{density, RotatedLinear{.lame = Lame::from_young_poisson(1e4, 0.3)}, {}}});
    auto x = at_rest(mesh);
    const auto bounds = all_bounds(mesh, elastic, x);
    const double limit = step_limit(bounds.truth);
    const double certified = step_limit(bounds.collatz_wielandt) / limit;
    EXPECT_LE(certified, 1 + 1e-9) << name;
    EXPECT_GE(certified, 0.95) << name;
    EXPECT_GE(std::min(bounds.eq9, bounds.eq8_upper), bounds.truth * (1 - 1e-9)) << name;
    verify(std::string(name) + ": Collatz-Wielandt step over the true one", "1", certified, "0.95 to 1");
    if (true_limit == 0) continue;
    EXPECT_NEAR(limit, true_limit, 5e-3 * true_limit) << name;
    verify(std::string(name) + ": true limit of the step [ms]", formatted("%g", 1e3 * true_limit),
           1e3 * limit, "0.5 %");
  }
}

}  // namespace
}  // namespace evert::test
