// Which elements the selections filter, and that nothing is left above the limit.
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "filtered_body.hpp"
#include "tests/support/thorough.hpp"
#include "tests/support/verify.hpp"
#include <random>
#include <string>

namespace evert::test {
namespace {

using enum FilterSelection;
constexpr std::array selections{paper, spare_mass, adaptive};

class OnMesh : public testing::TestWithParam<ReferenceMesh> {
 protected:
  void SetUp() override {
    const auto path = shared_mesh(std::string(GetParam().name) + ".msh");
    if (!path) GTEST_SKIP() << GetParam().name << ".msh is not in EVERT_SHARED_MESHES";
    mesh_ = distributed(*path);
    alone_ = distributed(*path, PETSC_COMM_SELF);
    limit_ = 2 / std::sqrt(FilteredBody(mesh_, GetParam().density).largest_eigenvalue());
  }
  [[nodiscard]] FilteredBody body() const { return {mesh_, GetParam().density}; }

  DistributedMesh mesh_, alone_;
  double limit_ = 0;  // largest stable step without a filter [s]
};

/// Two hundred with EVERT_THOROUGH=1, which takes minutes.
int trials_on(const DistributedMesh& mesh) {
  if (size_of(PETSC_COMM_WORLD) > 1) return 3;
  if (thorough()) return 200;
  return mesh.total_cells < 1000 ? 20 : 5;
}

TEST_P(OnMesh, NothingIsLeftAboveTheLimit) {
  for (const auto selection : selections) {
    std::mt19937_64 random(11);
    double worst = 0, rigid = 0;
    const int trials = trials_on(mesh_);
    for (int trial = 0; trial < trials; ++trial) {
      const double times = std::pow(10, std::uniform_real_distribution<double>(0, 0.5)(random));
      auto filtered = body();
      const auto options = at_step(times * limit_, selection);
      const ModalFilter filter(filtered.mesh, filtered.elastic, options);
      EXPECT_GT(filtered.over_ranks(filter.filtered_cells()), 0) << times;
      worst = std::max(worst, filtered.largest_eigenvalue() / options.limit());
      rigid = std::max(rigid, filtered.rigid_residual() / options.limit());
      if (selection == adaptive) {
        EXPECT_LE(filtered.collatz_wielandt(), options.limit() * (1 + 1e-9)) << times;
      }
    }
    EXPECT_LE(worst, 1 + 1e-9) << name_of(selection);
    EXPECT_LE(rigid, 1e-12) << name_of(selection);
    const std::string what = "modal filter: " + std::string(GetParam().name) + ", " + name_of(selection) +
                             ", " + std::to_string(trials) + " random steps: ";
    test::verify(what + "largest eigenvalue over the limit", "at most 1", worst, "1e-9");
    test::verify(what + "forces of rigid motions over those at the limit", "0", rigid, "1e-12");
  }
}

TEST_P(OnMesh, SpareMassFiltersNothingThatPaperDoesNot) {
  GlobalIndex only_by_spare = 0;
  for (const double times : {1.1, 1.5, 2.0, 3.0}) {
    auto by_paper = body(), by_spare = body();
    const ModalFilter more(mesh_, by_paper.elastic, at_step(times * limit_, paper));
    const ModalFilter fewer(mesh_, by_spare.elastic, at_step(times * limit_, spare_mass));
    for (std::size_t c = 0; c < more.clamps().size(); ++c)
      only_by_spare += fewer.clamps()[c].limit > more.clamps()[c].limit ? 1 : 0;
  }
  only_by_spare = body().over_ranks(only_by_spare);
  EXPECT_EQ(only_by_spare, 0);
  test::verify(
      "modal filter: " + std::string(GetParam().name) +
          " at 1.1, 1.5, 2 and 3 times its step: elements that spare_mass filters and paper does not",
      "0", static_cast<double>(only_by_spare), "0");
}

/// Every rank compares its cells with what it finds when it has the whole mesh to itself.
TEST_P(OnMesh, EveryNumberOfRanksFiltersTheSame) {
  for (const auto selection : selections) {
    auto shared = body();
    FilteredBody whole(alone_, GetParam().density);
    const ModalFilter filter(mesh_, shared.elastic, at_step(2 * limit_, selection));
    const ModalFilter expected(alone_, whole.elastic, at_step(2 * limit_, selection));
    const auto all = by_global_number(alone_, expected.clamps());
    double worst = 0;
    for (const auto& [cell, clamp] : by_global_number(mesh_, filter.clamps()))
      worst = std::max(worst, difference(clamp, all.at(cell)));
    EXPECT_LE(worst, 1e-9) << name_of(selection);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, OnMesh, testing::ValuesIn(reference_meshes),
                         [](const auto& of) { return std::string(of.param.name); });

/// The elements that a selection filters of a shared mesh at so many times its own step.
GlobalIndex filtered_at(const ReferenceMesh& reference, int times, FilterSelection selection,
                        const std::string& expected) {
  const auto mesh = distributed(*shared_mesh(std::string(reference.name) + ".msh"));
  FilteredBody body(mesh, reference.density);
  const double limit = 2 / std::sqrt(body.largest_eigenvalue());
  const ModalFilter filter(mesh, body.elastic, at_step(times * limit, selection));
  const auto count = body.over_ranks(filter.filtered_cells());
  test::verify("modal filter: elements filtered of " + std::string(reference.name) + " at " +
                   std::to_string(times) + " times its step, " + name_of(selection),
               expected, static_cast<double>(count), "");
  return count;
}

TEST(Selection, FiltersFewElementsOfTheBalls) {
  if (size_of(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "EveryNumberOfRanksFiltersTheSame";
  if (!shared_mesh("ball404.msh") || !shared_mesh("ball20k.msh"))
    GTEST_SKIP() << "ball404.msh and ball20k.msh are not in EVERT_SHARED_MESHES";
  const auto& small = reference_meshes[2];
  const auto& large = reference_meshes[3];
  const auto many = filtered_at(small, 2, paper, "more than the others");
  EXPECT_LT(filtered_at(small, 2, spare_mass, "at most 6"), std::min<GlobalIndex>(many, 7));
  EXPECT_LE(filtered_at(small, 2, adaptive, "at most 6"), 6);
  EXPECT_NEAR(static_cast<double>(filtered_at(large, 10, paper, "1927 +- 2 % (prototype)")), 1927,
              0.02 * 1927);
  EXPECT_LE(filtered_at(large, 10, spare_mass, "at most half of that"), 1927 / 2);
  EXPECT_LE(filtered_at(large, 10, adaptive, "at most 200"), 200);
}

TEST(Selection, FollowsAMaterialRegionByRegion) {
  Mesh halves = generate_box({{1, 0.5, 0.5}}, {8, 4, 4}, BoxCells::tet6);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (auto& node : halves.nodes) node += Vec3d{shift(random), shift(random), shift(random)};
  auto& cells = halves.cells.front();
  halves.regions = {"left", "right"};
  for (std::size_t c = 0; c < cells.region.size(); ++c)
    cells.region[c] = halves.nodes[static_cast<std::size_t>(cells.nodes[4 * c])][0] < 0 ? 0 : 1;
  reorient(halves);
  const auto mesh = distribute(PETSC_COMM_WORLD, halves);
  for (const auto selection : selections) {
    FilteredBody body(mesh, 1000), fresh(mesh, 1000);
    const auto options = at_step(1.3 * 2 / std::sqrt(body.largest_eigenvalue()), selection);
    ModalFilter filter(mesh, body.elastic, options);
    const auto before = body.over_ranks(filter.filtered_cells());
    for (auto* elastic : {&body.elastic, &fresh.elastic})
      elastic->set_properties(1, reference_properties(1000, 3e4));
    filter.material_changed(1);
    const ModalFilter expected(mesh, fresh.elastic, options);
    EXPECT_GT(body.over_ranks(filter.filtered_cells()), before) << name_of(selection);
    EXPECT_LE(body.largest_eigenvalue(), options.limit() * (1 + 1e-9)) << name_of(selection);
    EXPECT_LT(body.over_ranks(filter.looked_at()),
              selection == adaptive ? mesh.total_cells + 1 : mesh.total_cells);
    if (selection == adaptive) continue;  // what has been softened stays so
    for (std::size_t c = 0; c < filter.clamps().size(); ++c)
      EXPECT_LE(difference(filter.clamps()[c], expected.clamps()[c]), 1e-12) << name_of(selection);
  }
}

}  // namespace
}  // namespace evert::test
