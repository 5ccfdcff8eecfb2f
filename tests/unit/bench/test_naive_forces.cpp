#include "evert/bench/naive_forces.hpp"

#include <gtest/gtest.h>

#include "tests/unit/forces/bodies.hpp"

namespace evert::bench {
namespace {

using namespace evert::test;

// Rounding of the SVD and of F, by parts of 1e-16, grows by the condition of the rest shapes and by the
// stiffness that the material reaches over its stress: a few hundred.
constexpr double tolerance = 1e-12;

TEST(NaiveForces, AreThoseOfTheKernels) {
  const auto body = box(CellType::tet4, 4, 3, 5);
  const NeoHookean material{.lame = soft};
  const NaiveForces naive(body.nodes, body.rest, material);
  for (const auto& [name, x, unique] : awkward_states(body)) {
    if (!unique) continue;
    const auto block = make_elastic_block(body.elastic_cells(), body.rest, material, no_damping);
    const auto expected = forces(*block, x);
    NodalValues f = zeros(body.rest.size());
    naive.add(x, f, 0, naive.cells());
    EXPECT_LE(largest_difference(f, expected), tolerance * largest(expected)) << name;
  }
}

TEST(NaiveForces, SeesInvertedCells) {
  const auto body = box(CellType::tet4, 4, 3, 5);
  const NaiveForces naive(body.nodes, body.rest, {.lame = soft});
  const auto x = deformed(body, [](const Vec3d& p) { return Vec3d{p[0], p[1], -p[2]}; });
  for (std::size_t cell = 0; cell < naive.cells(); ++cell)
    EXPECT_LT(determinant(naive.deformation_gradient(x, cell)), 0);
}

}  // namespace
}  // namespace evert::bench
