#include "evert/filter/shape_class.hpp"
#include "evert/math/svd3.hpp"
#include "evert/mesh/cell_geometry.hpp"

#include <gtest/gtest.h>

#include "tests/support/shared_meshes.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace evert {
namespace {

using Corners = std::array<Vec3d, 4>;

struct Example {
  ShapeClass shape;
  Corners corners;
};

/// Tetrahedra whose short distances are 1 % of their long ones.  paper B, figure 1
const std::vector<Example> examples{
    {ShapeClass::well_shaped, {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.87, 0}, {0.5, 0.29, 0.82}}}},
    {ShapeClass::well_shaped, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {ShapeClass::needle, {{{0, 0, 0}, {0.01, 0, 0}, {0.005, 0.009, 0}, {0.005, 0.003, 1}}}},
    {ShapeClass::spindle, {{{0, 0, 0}, {0.01, 0, 0}, {0, 0.005, 1}, {0.01, -0.005, 1.001}}}},
    {ShapeClass::spindle, {{{0, 0, 0}, {1, 0, 0}, {0.4, 0.01, 0}, {0.6, 0.005, 0.01}}}},
    {ShapeClass::wedge, {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.87, 0}, {0.5, 0.87, 0.01}}}},
    {ShapeClass::cap, {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.87, 0}, {0.5, 0.29, 0.01}}}},
    {ShapeClass::sliver, {{{0, 0, 0}, {1, 1, 0}, {1, 0, 0.01}, {0, 1, 0.01}}}},
};

class Shape : public testing::TestWithParam<std::size_t> {};

TEST_P(Shape, IsKnownHoweverItIsTurnedScaledAndNumbered) {
  const auto& [expected, corners] = examples[GetParam()];
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  do {
    Mat3d any;
    for (auto& column : any.column) column = {normal(random), normal(random), normal(random)};
    const auto svd = svd3(any);
    const Mat3d rotation = times_transpose(svd.u, svd.v);
    const double scale = std::pow(10.0, 6 * normal(random));
    Corners turned;
    for (std::size_t a = 0; a < 4; ++a) turned[a] = scale * (rotation * corners[order[a]] + Vec3d{3, -2, 1});
    EXPECT_EQ(name_of(shape_class(turned)), name_of(expected));
  } while (std::next_permutation(order.begin(), order.end()));
}

INSTANTIATE_TEST_SUITE_P(All, Shape, testing::Range(std::size_t{0}, examples.size()));

TEST(Shape, ClassesAreAllAmongTheExamplesAndNamedDifferently) {
  for (const auto shape : all_shape_classes) {
    EXPECT_TRUE(std::ranges::any_of(examples, [&](const Example& e) { return e.shape == shape; }));
    EXPECT_EQ(std::ranges::count_if(all_shape_classes,
                                    [&](ShapeClass other) { return name_of(other) == name_of(shape); }),
              1);
  }
}

TEST(Shape, OfTheSixThinCellsOfTheWedgeStackIsWedge) {
  const auto path = test::shared_mesh("wedge_stack.msh");
  if (!path) GTEST_SKIP() << "wedge_stack.msh is not there: set EVERT_SHARED_MESHES to its folder";
  std::map<ShapeClass, int> count;
  for_each_cell(read_mesh(*path),
                [&](GlobalIndex, const CellBlock&, std::size_t, std::span<const Vec3d> nodes) {
                  ++count[shape_class(nodes.first<4>())];
                });
  EXPECT_EQ(count, (std::map<ShapeClass, int>{{ShapeClass::well_shaped, 2}, {ShapeClass::wedge, 6}}));
}

}  // namespace
}  // namespace evert
