#include <gtest/gtest.h>

#include "bodies.hpp"
#include "reference_forces.hpp"
#include <cstring>
#include <iomanip>
#include <iostream>

/// Elements in float between nodes in double, against long double and against all in double.
namespace evert::test {
namespace {

/// Tolerances of the tests in double, for the same roundings of another size.
constexpr double floats = std::numeric_limits<float>::epsilon() / std::numeric_limits<double>::epsilon();

Body small_body(CellType type) { return type == CellType::tet4 ? box(type, 2, 2, 2) : box(type, 3, 2, 2); }

std::string label(const Body& body, const Material& material, const std::string& state) {
  return std::string(evert::name_of(body.type)) + ", " + name_of(material) + ", " + state;
}

std::unique_ptr<ElasticBlock> mixed_block(const kernels::CpuLevel& level, const Body& body,
                                          const Material& material, const Damping& damping,
                                          LocalIndex interior = 0) {
  return make_elastic_block(body.elastic_cells(interior), body.rest, material, damping,
                            level.find_mixed(body.type, material, damping.model));
}

std::unique_ptr<ElasticBlock> mixed_block(const Body& body, const Material& material,
                                          const Damping& damping) {
  return make_elastic_block(body.elastic_cells(body.cells() / 2), body.rest, material, damping,
                            Precision::mixed);
}

std::unique_ptr<ElasticBlock> full_block(const Body& body, const Material& material, const Damping& damping) {
  return make_elastic_block(body.elastic_cells(body.cells() / 2), body.rest, material, damping,
                            Precision::full);
}

/// F is rounded by parts of 1, so the error of a force is relative to the moduli and not to the force.
TEST(MixedPrecision, ForcesAreAsExactAsFloatsAllow) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    for (const Material& material : all_materials()) {
      for (const auto& level : supported_levels()) {
        const auto block = mixed_block(level, body, material, no_damping, 5);
        for (const State& state : awkward_states(body)) {
          if (!state.unique) continue;
          const NodalValues f = forces(*block, state.x);
          const ReferenceForces reference = reference_forces(body, material, state.x);
          for (std::size_t i = 0; i + 1 < f.size(); ++i) {
            EXPECT_NEAR(f[i], static_cast<double>(reference.forces[i / 3][i % 3]),
                        1e-14 * floats * static_cast<double>(reference.stiffness[i / 3]))
                << label(body, material, state.name) << ", " << level.name;
          }
          EXPECT_EQ(f.back(), 0) << "wrote into the slack";
        }
      }
    }
  }
}

/// Differences of positions are taken in double: far from the origin nothing is lost but what the positions
/// themselves lose.
TEST(MixedPrecision, IgnoresWhereTheBodyIs) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const Material material = NeoHookean{.lame = soft};
    const auto block = mixed_block(body, material, no_damping);
    const NodalValues x = awkward_states(body).front().x;
    std::vector<Vec3d> moved;
    for (std::size_t node = 0; node < body.rest.size(); ++node)
      moved.push_back(at_node(x, node) + Vec3d{1024, -4096, 2048});
    const ReferenceForces reference = reference_forces(body, material, x);
    const NodalValues f = forces(*block, x), far = forces(*block, nodal_values(moved));
    for (std::size_t i = 0; i + 1 < f.size(); ++i)
      EXPECT_NEAR(f[i], far[i], 1e-14 * floats * static_cast<double>(reference.stiffness[i / 3]));
  }
}

/// Forces are summed in double, those of a cell to nothing.
TEST(MixedPrecision, HasNoResultant) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    for (const Material& material : all_materials()) {
      const auto block = mixed_block(body, material, rotated_damping);
      for (const State& state : awkward_states(body)) {
        const NodalValues f = forces(*block, state.x);
        const NodalValues d = damping_product(*block, random_velocities(body.rest.size()));
        Vec3d of_forces{}, of_damping{};
        for (std::size_t node = 0; node < body.rest.size(); ++node) {
          of_forces += at_node(f, node);
          of_damping += at_node(d, node);
        }
        EXPECT_LE(norm(of_forces), 1e-13 * largest(f) * static_cast<double>(body.rest.size()))
            << label(body, material, state.name);
        EXPECT_LE(norm(of_damping), 1e-13 * largest(d) * static_cast<double>(body.rest.size()))
            << label(body, material, state.name);
      }
    }
  }
}

/// The operator of the rounded state is still one operator: symmetric to the rounding of its product, and as
/// near to that of the state in double as floats are.
TEST(MixedPrecision, DampingIsNearThatInDouble) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues v = random_velocities(body.rest.size()), w = random_velocities(body.rest.size(), 6);
    const auto product = [](const NodalValues& a, const NodalValues& b) {
      double sum = 0;
      for (std::size_t i = 0; i + 1 < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    for (const Damping& damping : {rotated_damping, objective_damping, blended_damping}) {
      const auto mixed = mixed_block(body, NeoHookean{.lame = soft}, damping);
      const auto full = full_block(body, NeoHookean{.lame = soft}, damping);
      for (const State& state : awkward_states(body)) {
        if (!state.unique) continue;
        forces(*mixed, state.x);
        forces(*full, state.x);
        const NodalValues expected = damping_product(*full, v), found = damping_product(*mixed, v);
        EXPECT_LE(largest_difference(found, expected), 2e-14 * floats * largest(expected)) << state.name;
        EXPECT_NEAR(product(w, found), product(v, damping_product(*mixed, w)),
                    1e-14 * floats * product(v, expected))
            << state.name;
        EXPECT_GE(product(v, found), 0) << state.name;

        const NodalValues diagonal = damping_diagonal(*mixed, body.rest.size()),
                          expected_diagonal = damping_diagonal(*full, body.rest.size());
        EXPECT_LE(largest_difference(diagonal, expected_diagonal),
                  1e-14 * floats * largest(expected_diagonal))
            << state.name;

        const std::size_t n = 9 * body.nodes_per_cell() * body.nodes_per_cell();
        NodalValues matrix(n + 1, 0.0), expected_matrix = matrix;
        mixed->damping_matrix(5, std::span(matrix).first(n));
        full->damping_matrix(5, std::span(expected_matrix).first(n));
        EXPECT_LE(largest_difference(matrix, expected_matrix), 1e-14 * floats * largest(expected_matrix))
            << state.name;
      }
    }
  }
}

TEST(MixedPrecision, MeasuresAreNearThoseInDouble) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const NodalValues v = random_velocities(body.rest.size());
    for (const Material& material : all_materials()) {
      const auto mixed = mixed_block(body, material, rotated_damping);
      const auto full = full_block(body, material, rotated_damping);
      const double volume = body.type == CellType::tet4 ? 8e-3 : 12e-3;
      for (const State& state : awkward_states(body)) {
        SCOPED_TRACE(label(body, material, state.name));
        const double* x = state.x.data();
        EXPECT_NEAR(mixed->energy(x), full->energy(x),
                    1e-14 * floats * (full->energy(x) + volume * (2 * soft.mu + 3 * soft.lambda)));
        const auto cells = static_cast<std::size_t>(body.cells());
        std::vector<double> stretch(cells), expected(cells);
        mixed->min_stretch(x, stretch);
        full->min_stretch(x, expected);
        for (std::size_t c = 0; c < cells; ++c) EXPECT_NEAR(stretch[c], expected[c], 2e-14 * floats);
        const StableStep step = mixed->stable_step(x), expected_step = full->stable_step(x);
        // Divided differences of stresses, over stretches that differ by a thousandth or more.
        const double divided = 1e-14 * floats / 1e-3;
        EXPECT_NEAR(step.undamped / expected_step.undamped, 1, divided);
        EXPECT_NEAR(step.damped / expected_step.damped, 1, divided);
        if (!state.unique) continue;
        forces(*mixed, state.x);  // strain rates are taken in the frames of the last update
        forces(*full, state.x);
        EXPECT_NEAR(mixed->max_strain_rate(x, v.data()) / full->max_strain_rate(x, v.data()), 1,
                    2e-14 * floats);
      }
    }
  }
}

TEST(MixedPrecision, CountsTheInverted) {
  for (const CellType type : all_elements) {
    const Body body = small_body(type);
    const auto block = mixed_block(body, NeoHookean{.lame = soft}, no_damping);
    const LocalIndex points = body.cells() * points_per_cell(type);
    const auto inverted = [&](const Vec3d& scale) {
      return block->inverted_points(deformed(body, [&](const Vec3d& p) {
                                      return Vec3d{scale[0] * p[0], scale[1] * p[1], scale[2] * p[2]};
                                    }).data());
    };
    EXPECT_EQ(inverted({1, 1, 1}), 0);
    EXPECT_EQ(inverted({1, -1, 1}), points);
    EXPECT_EQ(inverted({1, -1e-3, 1}), points);
    EXPECT_EQ(inverted({1, 0, 1}), 0);
  }
}

TEST(MixedPrecision, AStateThatIsNotFiniteHasNoStableStep) {
  const Body body = small_body(CellType::tet4);
  const auto block = mixed_block(body, NeoHookean{.lame = soft}, rotated_damping);
  NodalValues x = nodal_values(body.rest);
  x[3] = std::numeric_limits<double>::infinity();
  EXPECT_LE(block->stable_step(x.data()).undamped, 1e-12);
  EXPECT_TRUE(std::isnan(forces(*block, x)[3]));
}

TEST(MixedPrecision, IsBitwiseRepeatableAndPaddingIsSafe) {
  for (const CellType type : all_elements) {
    const Body whole = box(type, 3, 3, 2);
    for (const LocalIndex cells : {1, 2, 3, 5, 8, 15, 16, 17}) {
      Body body = whole;
      body.nodes.resize(static_cast<std::size_t>(cells) * whole.nodes_per_cell());
      const Material material = NeoHookean{.lame = soft};
      const NodalValues x = awkward_states(body)[2].x;
      const auto first = mixed_block(body, material, rotated_damping);
      const auto second = mixed_block(body, material, rotated_damping);
      const NodalValues a = forces(*first, x), b = forces(*second, x), again = forces(*first, x);
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
      EXPECT_EQ(std::memcmp(a.data(), again.data(), a.size() * sizeof(double)), 0);
      const ReferenceForces reference = reference_forces(body, material, x);
      for (std::size_t i = 0; i + 1 < a.size(); ++i)
        EXPECT_NEAR(a[i], static_cast<double>(reference.forces[i / 3][i % 3]),
                    1e-14 * floats * static_cast<double>(reference.stiffness[i / 3]))
            << cells << " cells";
    }
  }
}

/// The table of docs/performance.md: the error of all forces relative to all forces, of a block stretched by
/// the strain and shaken by a tenth of it.
TEST(MixedPrecision, ErrorGrowsAsStrainFalls) {
  const Body body = box(CellType::tet4, 8, 8, 8);
  std::cout << "strain   neo_hookean  rotated_linear  st_venant_kirchhoff\n";
  for (const double strain : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    std::cout << std::scientific << std::setprecision(0) << strain;
    for (const Material& material :
         {Material{NeoHookean{.lame = soft}}, Material{RotatedLinear{.lame = soft}},
          Material{StVenantKirchhoff{.lame = soft}}}) {
      const NodalValues x = deformed(
          body,
          [=](const Vec3d& p) {
            return Vec3d{(1 + strain) * p[0], p[1], p[2]};
          },
          0.01 * strain);
      const NodalValues expected = forces(*full_block(body, material, no_damping), x);
      const NodalValues f = forces(*mixed_block(body, material, no_damping), x);
      double error = 0, square = 0;
      for (std::size_t i = 0; i + 1 < f.size(); ++i) {
        error += (f[i] - expected[i]) * (f[i] - expected[i]);
        square += expected[i] * expected[i];
      }
      const double relative = std::sqrt(error / square);
      std::cout << std::setw(14) << std::setprecision(1) << relative;
      // A few roundings of F, which is 1, against a strain.
      EXPECT_LE(relative, 10 * std::numeric_limits<float>::epsilon() / strain) << name_of(material);
    }
    std::cout << '\n';
  }
}

TEST(MixedPrecision, NeedsHalfTheMemory) {
  const Body body = box(CellType::tet4, 8, 8, 8);
  const Material material = NeoHookean{.lame = soft};
  const auto bytes = [&](const auto& block) { return static_cast<double>(block->memory()) / body.cells(); };
  EXPECT_NEAR(bytes(full_block(body, material, rotated_damping)) -
                  bytes(mixed_block(body, material, rotated_damping)),
              4 * (6 + 1 + 9), 1);
}

}  // namespace
}  // namespace evert::test
