#include "evert/forces/kernels/kernel_table.hpp"
#include "evert/forces/kernels/tensor_product.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "reference_forces.hpp"

/// hex8 axis by axis against hex8 with its shape gradients, as any other element.
namespace evert::test {
namespace {

using kernels::Cube;

Cube<double> random_cube(std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 1);
  Cube<double> values;
  for (double& value : values) value = normal(random);
  return values;
}

/// One operator of one axis at a time makes the gradients that the element lists.
TEST(TensorProduct, GradientsAreThoseOfTheElement) {
  std::mt19937_64 random(3);
  const Cube<double> u = random_cube(random);
  std::array<Vec3d, 8> found{};
  int stored = 0;
  kernels::reference_gradients(u, [&](std::size_t q, std::size_t k, double slope) {
    found[q][k] = slope;
    ++stored;
  });
  EXPECT_EQ(stored, 24);
  for (std::size_t q = 0; q < 8; ++q) {
    Vec3d expected{};
    for (std::size_t a = 0; a < 8; ++a) expected += u[kernels::cube_corner_of_node[a]] * hex8.gradients[q][a];
    // Ten roundings of numbers up to 3.
    EXPECT_LE(norm(found[q] - expected), 1e-14) << "point " << q;
  }
}

TEST(TensorProduct, TransposeIsTheTranspose) {
  std::mt19937_64 random(4);
  for (std::size_t q = 0; q < 8; ++q) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Cube<double> u = random_cube(random);
      double forth = 0;
      kernels::reference_gradients(u, [&](std::size_t point, std::size_t axis, double slope) {
        if (point == q && axis == k) forth = slope;
      });
      const Cube<double> transposed = kernels::reference_gradients_transposed<double>(
          [&](std::size_t point, std::size_t axis) { return point == q && axis == k ? 1.0 : 0.0; });
      double back = 0;
      for (std::size_t a = 0; a < 8; ++a) back += u[a] * transposed[a];
      EXPECT_NEAR(forth, back, 1e-14) << "point " << q << ", axis " << k;
    }
  }
}

std::unique_ptr<ElasticBlock> general_block(const Body& body, const Material& material,
                                            const Damping& damping) {
  const auto kernels = kernels::kernels_of<double, hex8_by_gradients>(material, damping.model);
  return make_elastic_block(body.elastic_cells(), body.rest, material, damping, kernels);
}

TEST(SumFactorisation, ForcesAndMeasuresEqualTheGeneralPath) {
  const Body body = box(CellType::hex8, 3, 2, 2);
  const NodalValues v = random_velocities(body.rest.size());
  for (const Material& material : all_materials()) {
    const auto general = general_block(body, material, rotated_damping);
    const auto factorised = scalar_block(body, material, rotated_damping);
    for (const State& state : awkward_states(body)) {
      const std::string label = name_of(material) + ", " + state.name;
      const double* x = state.x.data();
      if (state.unique) {
        const NodalValues expected = forces(*general, state.x);
        const NodalValues f = forces(*factorised, state.x);
        const ReferenceForces reference = reference_forces(body, material, state.x);
        for (std::size_t i = 0; i + 1 < f.size(); ++i)
          EXPECT_NEAR(f[i], expected[i], 1e-14 * static_cast<double>(reference.stiffness[i / 3])) << label;
      }
      EXPECT_NEAR(factorised->energy(x), general->energy(x), 1e-13 * general->energy(x)) << label;
      EXPECT_EQ(factorised->inverted_points(x), general->inverted_points(x)) << label;
      // Newton's steps for the largest eigenvalue add a few roundings of their own.
      EXPECT_NEAR(factorised->stable_step(x).damped / general->stable_step(x).damped, 1, 1e-12) << label;
      if (!state.unique) continue;
      EXPECT_NEAR(factorised->max_strain_rate(x, v.data()) / general->max_strain_rate(x, v.data()), 1, 1e-13)
          << label;
    }
  }
}

TEST(SumFactorisation, DampingEqualsTheGeneralPath) {
  const Body body = box(CellType::hex8, 3, 2, 2);
  const NodalValues v = random_velocities(body.rest.size());
  const Material material = NeoHookean{.lame = soft};
  for (const Damping& damping : {rotated_damping, objective_damping}) {
    const auto general = general_block(body, material, damping);
    const auto factorised = scalar_block(body, material, damping);
    for (const State& state : awkward_states(body)) {
      if (!state.unique) continue;
      forces(*general, state.x);
      forces(*factorised, state.x);
      const NodalValues expected = damping_product(*general, v);
      EXPECT_LE(largest_difference(damping_product(*factorised, v), expected), 1e-14 * largest(expected))
          << state.name;

      const NodalValues diagonal = damping_diagonal(*factorised, body.rest.size()),
                        expected_diagonal = damping_diagonal(*general, body.rest.size());
      EXPECT_LE(largest_difference(diagonal, expected_diagonal), 1e-14 * largest(expected_diagonal))
          << state.name;

      NodalValues matrix(24 * 24 + 1, 0.0), expected_matrix = matrix;
      factorised->damping_matrix(5, std::span(matrix).first(576));
      general->damping_matrix(5, std::span(expected_matrix).first(576));
      EXPECT_LE(largest_difference(matrix, expected_matrix), 1e-14 * largest(expected_matrix)) << state.name;
    }
  }
}

/// What is kept per point: (∂X/∂ξ)⁻¹ instead of 21 shape gradients.
TEST(SumFactorisation, NeedsLessMemory) {
  const Body body = box(CellType::hex8, 4, 4, 4);
  const Material material = NeoHookean{.lame = soft};
  const std::size_t points = 8 * 64;
  EXPECT_EQ(general_block(body, material, no_damping)->memory() -
                scalar_block(body, material, no_damping)->memory(),
            points * (21 - 9) * sizeof(double));
}

}  // namespace
}  // namespace evert::test
