#include "evert/core/error.hpp"
#include "evert/elements/reference_element.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evert {
namespace {

template <const auto& element>
struct Checked {
  static constexpr const auto& of = element;
};

template <class Which>
class ReferenceElements : public testing::Test {};
using All = testing::Types<Checked<tet4>, Checked<hex8>>;
TYPED_TEST_SUITE(ReferenceElements, All);

TYPED_TEST(ReferenceElements, HoldsTheTypesNodeCount) {
  EXPECT_EQ(TypeParam::of.nodes, node_count(TypeParam::of.type));
  with_reference_element(TypeParam::of.type,
                         [](const auto& element) { EXPECT_EQ(element.nodes, TypeParam::of.nodes); });
}

/// Σ N_a = 1 and Σ ∂N_a = 0: rigid translations stretch nothing.
TYPED_TEST(ReferenceElements, IsAPartitionOfUnity) {
  for (std::size_t q = 0; q < TypeParam::of.weights.size(); ++q) {
    double sum = 0;
    Vec3d gradient_sum{};
    for (std::size_t a = 0; a < TypeParam::of.values[q].size(); ++a) {
      EXPECT_GT(TypeParam::of.values[q][a], 0);  // so that lumped masses are positive
      sum += TypeParam::of.values[q][a];
      gradient_sum += TypeParam::of.gradients[q][a];
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    EXPECT_NEAR(norm(gradient_sum), 0, 1e-15);
  }
}

TEST(Tet4, HasTheReferenceVolume) { EXPECT_NEAR(tet4.weights[0], 1.0 / 6, 1e-16); }

/// The Gauss points integrate 1, ξ², ξ²η² and ξ²η²ζ² over [−1, 1]³; a point is Σ N_a corner_a.
TEST(Hex8, IntegratesQuadraticsOfEachAxis) {
  const double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  double integral[4] = {};
  for (std::size_t q = 0; q < 8; ++q) {
    double xi[3] = {};
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t i = 0; i < 3; ++i) xi[i] += hex8.values[q][a] * corner[a][i];
    }
    double term = hex8.weights[q];
    integral[0] += term;
    for (std::size_t i = 0; i < 3; ++i) integral[i + 1] += term *= xi[i] * xi[i];
  }
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(integral[i], 8 / std::pow(3.0, i), 1e-14);
}

/// N_a is 1 at its own corner: VTK's node order.
TEST(Hex8, GradientsMatchTheNodeOrder) {
  // Σ_a ξ_a ⊗ ∂N_a = I when ξ_a are the corners in VTK's order.
  const Vec3d corner[8] = {{{-1, -1, -1}}, {{1, -1, -1}}, {{1, 1, -1}}, {{-1, 1, -1}},
                           {{-1, -1, 1}},  {{1, -1, 1}},  {{1, 1, 1}},  {{-1, 1, 1}}};
  for (std::size_t q = 0; q < 8; ++q) {
    Mat3d jacobian{};
    for (std::size_t a = 0; a < 8; ++a) jacobian += outer(corner[a], hex8.gradients[q][a]);
    EXPECT_NEAR(norm(jacobian - identity<double>()), 0, 1e-15);
  }
}

TEST(WithReferenceElement, RefusesTypesWithoutElement) {
  try {
    with_reference_element(CellType::wedge6, [](const auto& /*element*/) {});
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(), "cells of type wedge6 cannot be simulated; allowed are tet4 or hex8");
  }
}

}  // namespace
}  // namespace evert
