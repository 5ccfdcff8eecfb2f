// An element that the library does not know, in this file alone, as docs/howto/new-element.md tells.
#include "evert/forces/kernels/kernel_table.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"

namespace evert::test {
namespace {

/// The trilinear hexahedron with one point, at its centre: a toy, since it has deformations without force,
/// but an element like any other to the kernels.
constexpr ReferenceElement<8, 1> make_one_point_hexahedron() {
  ReferenceElement<8, 1> hex{.type = CellType::hex8, .weights = {8}, .values = {}, .gradients = {}};
  constexpr std::array<Vec3d, 8> corners{{{{-1, -1, -1}},
                                          {{1, -1, -1}},
                                          {{1, 1, -1}},
                                          {{-1, 1, -1}},
                                          {{-1, -1, 1}},
                                          {{1, -1, 1}},
                                          {{1, 1, 1}},
                                          {{-1, 1, 1}}}};
  for (std::size_t a = 0; a < 8; ++a) {
    hex.values[0][a] = 0.125;
    hex.gradients[0][a] = 0.125 * corners[a];
  }
  return hex;
}

constexpr ReferenceElement<8, 1> one_point_hexahedron = make_one_point_hexahedron();

const Material material = NeoHookean{.lame = soft};

template <class T>
std::unique_ptr<ElasticBlock> toy_block(const Body& body, const Damping& damping) {
  const auto kernels = kernels::kernels_of<T, one_point_hexahedron>(material, damping.model);
  return make_elastic_block(one_point_hexahedron, body.elastic_cells(1), body.rest, material, damping,
                            kernels);
}

/// Where F is the same everywhere, one point sees what eight see, inverted or not.
TEST(OutsideElement, HasTheForcesOfTheHexahedronWhereFIsConstant) {
  const Body body = box(CellType::hex8, 3, 2, 2, 0.1, 0.0);
  const auto known = scalar_block(body, material, no_damping);
  for (const auto& toy : {toy_block<double>(body, no_damping), toy_block<Pack>(body, no_damping)}) {
    for (const double stretch : {1.3, 0.7, 0.0, -0.6}) {
      const Mat3d f = rotation(0.8) * diagonal(Vec3d{1.1, 0.9, stretch});
      const NodalValues x = deformed(body, [&](const Vec3d& p) { return f * p; });
      const NodalValues expected = forces(*known, x);
      EXPECT_LE(largest_difference(forces(*toy, x), expected), 1e-13 * largest(expected)) << stretch;
      EXPECT_NEAR(toy->energy(x.data()) / known->energy(x.data()), 1, 1e-13) << stretch;
      EXPECT_EQ(toy->inverted_points(x.data()), stretch < 0 ? body.cells() : 0);
    }
  }
}

TEST(OutsideElement, IsTheGradientOfItsEnergyOnDistortedCells) {
  const Body body = box(CellType::hex8, 2, 1, 1);
  const auto toy = toy_block<Pack>(body, no_damping);
  const auto energy = [&](const NodalValues& x) { return toy->energy(x.data()); };
  for (const State& state : awkward_states(body))
    if (state.unique) expect_gradient(forces(*toy, state.x), energy, state.x, state.name);
}

TEST(OutsideElement, SharesItsMass) {
  const Body body = box(CellType::hex8, 3, 2, 2, 0.1, 0.0);
  std::vector<double> masses(body.rest.size()), of_the_hexahedron(body.rest.size());
  add_lumped_mass(one_point_hexahedron, body.elastic_cells(), body.rest, masses);
  add_lumped_mass(body.elastic_cells(), body.rest, of_the_hexahedron);
  for (std::size_t node = 0; node < masses.size(); ++node)
    EXPECT_NEAR(masses[node], of_the_hexahedron[node], 1e-15);
}

/// Damping, its diagonal and its matrix, and the bound of the step follow from the element.
TEST(OutsideElement, IsDampedAndBoundsTheStep) {
  const Body body = box(CellType::hex8, 2, 2, 1);
  for (const Damping& damping : {rotated_damping, objective_damping}) {
    const auto toy = toy_block<Pack>(body, damping);
    const NodalValues x = awkward_states(body).front().x;
    static_cast<void>(forces(*toy, x));
    const NodalValues v = random_velocities(body.rest.size());
    const NodalValues product = damping_product(*toy, v);
    NodalValues by_matrices = zeros(body.rest.size());
    std::vector<double> matrix(24 * 24);
    for (LocalIndex cell = 0; cell < toy->cells(); ++cell) {
      toy->damping_matrix(cell, matrix);
      const CellNodes nodes = toy->cell_nodes(cell);
      for (std::size_t i = 0; i < 24; ++i) {
        for (std::size_t j = 0; j < 24; ++j)
          by_matrices[3 * static_cast<std::size_t>(nodes[i / 3]) + i % 3] +=
              matrix[24 * i + j] * v[3 * static_cast<std::size_t>(nodes[j / 3]) + j % 3];
      }
    }
    EXPECT_LE(largest_difference(product, by_matrices), 1e-13 * largest(product));
    double power = 0;
    for (std::size_t i = 0; i + 1 < v.size(); ++i) power += v[i] * product[i];
    EXPECT_GT(power, 0);
    const StableStep step = toy->stable_step(x.data());
    EXPECT_GT(step.undamped, 0);
    EXPECT_GE(step.damped, step.undamped);
  }
}

}  // namespace
}  // namespace evert::test
