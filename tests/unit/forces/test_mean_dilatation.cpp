#include <gtest/gtest.h>

#include "bodies.hpp"

/// The mean over a cell in the place of the dilatations of its points.
namespace evert::test {
namespace {

const std::vector<Material> with_dilatation{RotatedLinear{.lame = soft}, NeoHookean{.lame = soft}};

std::unique_ptr<ElasticBlock> mean_block(const Body& body, const Material& material, bool mean = true) {
  auto cells = body.elastic_cells();
  cells.mean_dilatation = mean;
  return make_elastic_block(cells, body.rest, material, no_damping);
}

TEST(MeanDilatation, LeavesForcesThatAreTheGradientOfTheEnergy) {
  for (const auto type : all_elements)
    for (const auto& material : with_dilatation) {
      const Body body = box(type, 1, 2, 1);
      const auto block = mean_block(body, material);
      for (const auto& state : awkward_states(body)) {
        if (!state.unique || state.name == "nearly flat" || state.name == "flat") continue;
        const auto f = forces(*block, state.x);
        expect_gradient(
            f, [&](const NodalValues& x) { return block->energy(x.data()); }, state.x,
            name_of(material) + ", " + state.name);
        expect_balance(state.x, f, state.name);
      }
    }
}

TEST(MeanDilatation, ChangesNothingOfWhatIsTheSameAtAllPoints) {
  for (const auto type : all_elements)
    for (const auto& material : with_dilatation) {
      const Body body = box(type, 2, 1, 1);
      const auto mean = mean_block(body, material), plain = mean_block(body, material, false);
      const auto x = deformed(body, [](const Vec3d& p) {
        return Vec3d{1.3 * p[0] + 0.2 * p[1], 0.8 * p[1], p[2]};
      });
      const auto f = forces(*plain, x);
      EXPECT_LE(largest_difference(forces(*mean, x), f), 1e-12 * largest(f));
      EXPECT_NEAR(mean->energy(x.data()), plain->energy(x.data()), 1e-12 * plain->energy(x.data()));
      for (const auto& state : awkward_states(body))
        EXPECT_LE(mean->energy(state.x.data()), plain->energy(state.x.data()) * (1 + 1e-12)) << state.name;
    }
}

/// A cube that is bent at constant volume to first order locks without it: as ν → 1/2 its energy grows
/// without bound.
TEST(MeanDilatation, DoesNotLock) {
  const Body body = box(CellType::hex8, 1, 1, 1, 1, 0);
  const auto bent = deformed(body, [](const Vec3d& p) {
    const double s = 0.02 * (p[0] - 0.5);
    return Vec3d{p[0] + s * (2 * p[1] - 1), p[1], p[2]};
  });
  const auto energy = [&](double nu, bool mean) {
    const NeoHookean material{.lame = Lame::from_young_poisson(1e4, nu)};
    return mean_block(body, material, mean)->energy(bent.data());
  };
  EXPECT_LT(energy(0.4999, true), 1.2 * energy(0.3, true));
  EXPECT_GT(energy(0.4999, false), 100 * energy(0.3, false));
}

}  // namespace
}  // namespace evert::test
