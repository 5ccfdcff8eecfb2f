// Whether a filter pays, and for which step.
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/mesh/generators.hpp"

#include <gtest/gtest.h>

#include "filtered_body.hpp"
#include <cmath>

namespace evert::test {
namespace {

constexpr double density = 1000;

/// A cube of 6·8³ tetrahedra; every node of `flattened` is moved towards the middle of a face of a cell of
/// its own until the cell has `height` of its height.
DistributedMesh cube(std::span<const std::array<int, 3>> flattened, double height) {
  constexpr int divisions = 8;
  Mesh mesh = generate_box({{1, 1, 1}}, {divisions, divisions, divisions}, BoxCells::tet6);
  const auto& cells = mesh.cells.front();
  for (const auto& [i, j, k] : flattened) {
    const auto moved = GlobalIndex{i} + (divisions + 1) * (j + (divisions + 1) * GlobalIndex{k});
    const auto at = std::ranges::find(cells.nodes, moved) - cells.nodes.begin();
    Vec3d middle{};
    for (std::ptrdiff_t a = 4 * (at / 4); a < 4 * (at / 4) + 4; ++a)
      if (a != at)
        middle += (1.0 / 3) * mesh.nodes[static_cast<std::size_t>(cells.nodes[static_cast<std::size_t>(a)])];
    auto& node = mesh.nodes[static_cast<std::size_t>(moved)];
    node = middle + height * (node - middle);
  }
  return distribute(PETSC_COMM_WORLD, mesh);
}

const DistributedMesh& with_slivers() {
  static const std::array<std::array<int, 3>, 3> nodes{{{2, 2, 2}, {5, 3, 4}, {3, 6, 6}}};
  static const DistributedMesh mesh = cube(nodes, 1e-3);
  return mesh;
}

std::string text_of(std::span<const FilterCandidate> candidates) {
  std::string text;
  for (const auto& c : candidates)
    text += formatted("%g x: %lld filtered, %g of the mass, gain %g, %s reach\n", c.multiple,
                      static_cast<long long>(c.filtered), c.softened, c.gain,
                      c.within_reach ? "within" : "beyond");
  return text;
}

ModalFilterOptions automatic() { return {.time_step = 0}; }

TEST(AutomaticStep, FiltersTheSliversOfABody) {
  const auto& mesh = with_slivers();
  FilteredBody body(mesh, density);
  const double unfiltered = 2 / std::sqrt(body.largest_eigenvalue());
  const ModalFilter filter(mesh, body.elastic, automatic());
  ASSERT_TRUE(filter.automatic());
  const auto& [own_step, candidates, time_step] = *filter.automatic();
  EXPECT_LE(own_step, 0.9 * unfiltered * (1 + 1e-6)) << "a bound";
  EXPECT_GE(own_step, 0.5 * unfiltered);
  ASSERT_TRUE(std::isfinite(time_step)) << text_of(candidates);
  EXPECT_EQ(filter.time_step(), time_step);
  EXPECT_LE(body.largest_eigenvalue(), filter.options().limit_of(time_step) * (1 + 1e-9));
  const auto chosen = std::ranges::find(candidates, time_step, &FilterCandidate::time_step);
  ASSERT_NE(chosen, candidates.end());
  EXPECT_EQ(chosen->filtered, body.over_ranks(filter.filtered_cells()));
  EXPECT_GT(chosen->filtered, 0);
  EXPECT_LE(chosen->softened, 0.05);
  for (const auto& other : candidates) {
    EXPECT_TRUE(!other.worthwhile(automatic()) || other.gain <= chosen->gain) << other.multiple;
  }
  // Few slivers: nearly all of the factor is gained.
  EXPECT_GT(chosen->gain, 0.9 * chosen->multiple);
  EXPECT_GE(chosen->multiple, 3);
}

TEST(AutomaticStep, CountsWhatTheSelectionFilters) {
  const auto& mesh = with_slivers();
  for (const auto selection : {FilterSelection::paper, FilterSelection::spare_mass}) {
    FilteredBody body(mesh, density);
    auto options = automatic();
    options.selection = selection;
    const auto candidates = choose_time_step(filter_problem(mesh, body.elastic), options).candidates;
    ASSERT_FALSE(candidates.empty());
    for (const auto& candidate : candidates) {
      if (!candidate.within_reach) continue;
      FilteredBody other(mesh, density);
      options.time_step = candidate.time_step;
      const ModalFilter filter(mesh, other.elastic, options);
      EXPECT_EQ(other.over_ranks(filter.filtered_cells()), candidate.filtered) << candidate.multiple;
    }
  }
}

TEST(AutomaticStep, LeavesABodyWithoutBadElementsAlone) {
  const auto mesh = cube({}, 1);
  FilteredBody body(mesh, density);
  const ModalFilter filter(mesh, body.elastic, automatic());
  EXPECT_TRUE(std::isinf(filter.time_step()));
  EXPECT_EQ(body.over_ranks(filter.filtered_cells()), 0);
  ASSERT_FALSE(filter.automatic()->candidates.empty());
  for (const auto& candidate : filter.automatic()->candidates)
    EXPECT_FALSE(candidate.worthwhile(automatic()));
}

TEST(AutomaticStep, SoftensNoMoreThanAllowed) {
  const auto& mesh = with_slivers();
  auto options = automatic();
  options.most_softened = 0;
  FilteredBody body(mesh, density);
  const ModalFilter filter(mesh, body.elastic, options);
  EXPECT_TRUE(std::isinf(filter.time_step()));
  EXPECT_EQ(body.over_ranks(filter.filtered_cells()), 0);
}

TEST(AutomaticStep, IsTheFixedStepOfTheIntegrator) {
  const auto& mesh = with_slivers();
  FilteredBody body(mesh, density);
  const double own = choose_time_step(filter_problem(mesh, body.elastic), automatic()).own_step;
  auto options = automatic();
  options.fixed_time_step = 0.9 * own;
  {
    const ModalFilter none(mesh, body.elastic, options);
    EXPECT_TRUE(std::isinf(none.time_step()));
    EXPECT_EQ(body.over_ranks(none.filtered_cells()), 0);
  }
  options.fixed_time_step = 2.5 * own;
  const ModalFilter filter(mesh, body.elastic, options);
  EXPECT_EQ(filter.time_step(), 2.5 * own);
  EXPECT_LE(body.largest_eigenvalue(), options.limit_of(2.5 * own) * (1 + 1e-9));
  options.fixed_time_step = 1e6 * own;
  FilteredBody other(mesh, density);
  EXPECT_THROW(ModalFilter(mesh, other.elastic, options), UserError);
}

/// As a filter made anew of the changed body.
TEST(AutomaticStep, IsChosenAnewWhenAMaterialChanges) {
  const auto& mesh = with_slivers();
  FilteredBody body(mesh, density), fresh(mesh, density);
  ModalFilter filter(mesh, body.elastic, automatic());
  const double before = filter.time_step();
  for (auto* elastic : {&body.elastic, &fresh.elastic})
    elastic->set_properties(0, reference_properties(density, 1e6));
  filter.material_changed(0);
  const ModalFilter expected(mesh, fresh.elastic, automatic());
  EXPECT_NEAR(filter.time_step(), before / 10, 1e-6 * before);
  EXPECT_NEAR(filter.time_step(), expected.time_step(), 1e-12 * before);
  ASSERT_EQ(filter.clamps().size(), expected.clamps().size());
  for (std::size_t c = 0; c < filter.clamps().size(); ++c)
    EXPECT_LE(difference(filter.clamps()[c], expected.clamps()[c]), 1e-12);
}

}  // namespace
}  // namespace evert::test
