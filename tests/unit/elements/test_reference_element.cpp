#include "evert/core/error.hpp"
#include "evert/elements/reference_element.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace evert {
namespace {

template <const auto& element>
struct Checked {
  static constexpr const auto& of = element;
};

template <class Which>
class ReferenceElements : public testing::Test {};
using All = testing::Types<Checked<tet4>, Checked<hex8>, Checked<wedge6>, Checked<tet10>>;
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

/// Where the nodes of a type are on the reference cell, in VTK's order.
std::vector<Vec3d> reference_nodes(CellType type) {
  const std::vector<Vec3d> tet{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  if (type == CellType::tet4) return tet;
  if (type == CellType::hex8)
    return {{{-1, -1, -1}}, {{1, -1, -1}}, {{1, 1, -1}}, {{-1, 1, -1}},
            {{-1, -1, 1}},  {{1, -1, 1}},  {{1, 1, 1}},  {{-1, 1, 1}}};
  if (type == CellType::wedge6)
    return {{{0, 0, -1}}, {{1, 0, -1}}, {{0, 1, -1}}, {{0, 0, 1}}, {{1, 0, 1}}, {{0, 1, 1}}};
  auto nodes = tet;
  for (const auto& [i, j] :
       std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}})
    nodes.push_back(0.5 * (tet[i] + tet[j]));
  return nodes;
}

/// ∂N_a/∂ξ are the derivatives of the same functions as N_a, with the nodes in VTK's order: a linear field
/// has its gradient, and so has a quadratic one where the element is quadratic.
TYPED_TEST(ReferenceElements, GradientsMatchTheNodeOrder) {
  const auto& element = TypeParam::of;
  const auto nodes = reference_nodes(element.type);
  for (std::size_t q = 0; q < element.weights.size(); ++q) {
    Vec3d at{}, slope_of_square{};
    Mat3d jacobian{};
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      at += element.values[q][a] * nodes[a];
      jacobian += outer(nodes[a], element.gradients[q][a]);
      slope_of_square += (nodes[a][0] * nodes[a][1]) * element.gradients[q][a];
    }
    EXPECT_NEAR(norm(jacobian - identity<double>()), 0, 2e-15);
    if (element.type == CellType::tet10) {
      EXPECT_NEAR(norm(slope_of_square - Vec3d{at[1], at[0], 0}), 0, 2e-15);
    }
  }
}

/// ∫ 1, ξ, ξ² over the reference cell.
template <const auto& element>
std::array<double, 3> moments() {
  const auto nodes = reference_nodes(element.type);
  std::array<double, 3> sums{};
  for (std::size_t q = 0; q < element.weights.size(); ++q) {
    double xi = 0;
    for (std::size_t a = 0; a < nodes.size(); ++a) xi += element.values[q][a] * nodes[a][0];
    for (std::size_t power = 0; power < 3; ++power)
      sums[power] += element.weights[q] * std::pow(xi, static_cast<double>(power));
  }
  return sums;
}

TEST(Wedge6, IntegratesQuadratics) {
  const auto [volume, first, second] = moments<wedge6>();
  EXPECT_NEAR(volume, 1, 1e-15);
  EXPECT_NEAR(first, 1.0 / 3, 1e-15);
  EXPECT_NEAR(second, 1.0 / 6, 1e-15);
}

TEST(Tet10, IntegratesQuadratics) {
  const auto [volume, first, second] = moments<tet10>();
  EXPECT_NEAR(volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR(first, 1.0 / 24, 1e-16);
  EXPECT_NEAR(second, 1.0 / 60, 1e-16);
}

/// Positive for any positive volumes of the points, and together the volume of the cell.
TYPED_TEST(ReferenceElements, LumpsPositively) {
  const auto& element = TypeParam::of;
  auto volumes = element.weights;
  for (std::size_t q = 0; q < volumes.size(); ++q) volumes[q] *= std::pow(10.0, static_cast<double>(q % 3));
  double volume = 0, sum = 0;
  for (const double of_point : volumes) volume += of_point;
  const auto shares = lumped_volumes(element, volumes);
  for (std::size_t a = 0; a < static_cast<std::size_t>(element.nodes); ++a) {
    EXPECT_GT(shares[a], 0);
    sum += shares[a];
  }
  EXPECT_NEAR(sum, volume, 1e-14 * volume);
}

TEST(WithReferenceElement, NamesTheTypesThatThereAre) {
  constexpr std::array known{CellType::tet4, CellType::hex8};
  try {
    detail::throw_no_reference_element(CellType::wedge6, known);
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(), "cells of type wedge6 cannot be simulated; allowed are tet4 or hex8");
  }
}

}  // namespace
}  // namespace evert
