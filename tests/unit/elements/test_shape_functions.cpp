#include "evert/elements/reference_element.hpp"
#include "evert/elements/shape_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evert {
namespace {

class ShapeFunctions : public testing::TestWithParam<CellType> {};

/// Where node `a` is in the reference cell: what the gradients of the elements belong to.
Vec3d node_at(CellType type, std::size_t a) {
  switch (type) {
    case CellType::tet4:
      return std::array<Vec3d, 4>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}[a];
    case CellType::hex8:
      return std::array<Vec3d, 8>{{{-1, -1, -1},
                                   {1, -1, -1},
                                   {1, 1, -1},
                                   {-1, 1, -1},
                                   {-1, -1, 1},
                                   {1, -1, 1},
                                   {1, 1, 1},
                                   {-1, 1, 1}}}[a];
    case CellType::wedge6:
      return std::array<Vec3d, 6>{{{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}[a];
    case CellType::tet10:
      break;
  }
  return std::array<Vec3d, 10>{{{0, 0, 0},
                                {1, 0, 0},
                                {0, 1, 0},
                                {0, 0, 1},
                                {0.5, 0, 0},
                                {0.5, 0.5, 0},
                                {0, 0.5, 0},
                                {0, 0, 0.5},
                                {0.5, 0, 0.5},
                                {0, 0.5, 0.5}}}[a];
}

TEST_P(ShapeFunctions, AreOneAtTheirNodeAndZeroAtTheOthers) {
  const auto nodes = static_cast<std::size_t>(node_count(GetParam()));
  for (std::size_t b = 0; b < nodes; ++b) {
    const auto values = shape_functions(GetParam(), node_at(GetParam(), b));
    for (std::size_t a = 0; a < most_nodes; ++a) EXPECT_NEAR(values[a], a == b ? 1 : 0, 1e-15) << a << b;
  }
}

/// The two definitions of an element are one: values at the element's points are those of the functions.
TEST_P(ShapeFunctions, AreThoseOfTheReferenceElement) {
  const ElementView element = reference_element(GetParam());
  for (std::size_t q = 0; q < element.points(); ++q) {
    Vec3d xi{};
    for (std::size_t a = 0; a < element.nodes(); ++a) xi += element.value(q, a) * node_at(GetParam(), a);
    const auto values = shape_functions(GetParam(), xi);
    for (std::size_t a = 0; a < element.nodes(); ++a) EXPECT_NEAR(values[a], element.value(q, a), 1e-15);
  }
}

TEST_P(ShapeFunctions, HaveTheGradientsOfTheQuadrature) {
  constexpr double h = 1e-6;
  for (const auto& point : mass_quadrature(GetParam()).points) {
    Vec3d xi{};
    for (std::size_t a = 0; a < most_nodes; ++a)
      if (a < static_cast<std::size_t>(node_count(GetParam())))
        xi += point.values[a] * node_at(GetParam(), a);
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3d forward = xi, backward = xi;
      forward[k] += h;
      backward[k] -= h;
      const auto above = shape_functions(GetParam(), forward), below = shape_functions(GetParam(), backward);
      for (std::size_t a = 0; a < most_nodes; ++a)
        EXPECT_NEAR(point.gradients[a][k], (above[a] - below[a]) / (2 * h), 1e-9);
    }
  }
}

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// ∫ ξ^i η^j ζ^k over the reference cell.
double monomial(CellType type, int i, int j, int k) {
  const auto line = [](int n) { return n % 2 == 0 ? 2.0 / (n + 1) : 0.0; };
  switch (type) {
    case CellType::hex8:
      return line(i) * line(j) * line(k);
    case CellType::wedge6:
      return factorial(i) * factorial(j) / factorial(i + j + 2) * line(k);
    case CellType::tet4:
    case CellType::tet10:
      break;
  }
  return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
}

/// The degrees that N_a N_b |∂X/∂ξ| has.
bool is_needed(CellType type, int i, int j, int k) {
  switch (type) {
    case CellType::tet4:
      return i + j + k <= 2;
    case CellType::hex8:
      return i <= 4 && j <= 4 && k <= 4;
    case CellType::wedge6:
      return i + j <= 3 && k <= 4;
    case CellType::tet10:
      break;
  }
  return i + j + k <= 7;
}

TEST_P(ShapeFunctions, AreIntegratedExactly) {
  const auto rule = mass_quadrature(GetParam());
  for (int i = 0; i <= 7; ++i)
    for (int j = 0; j <= 7; ++j)
      for (int k = 0; k <= 7; ++k) {
        if (!is_needed(GetParam(), i, j, k)) continue;
        double integral = 0;
        for (const auto& point : rule.points) {
          Vec3d xi{};
          for (std::size_t a = 0; a < rule.nodes; ++a) xi += point.values[a] * node_at(GetParam(), a);
          integral += point.weight * std::pow(xi[0], i) * std::pow(xi[1], j) * std::pow(xi[2], k);
        }
        EXPECT_NEAR(integral, monomial(GetParam(), i, j, k), 1e-14) << i << j << k;
      }
}

INSTANTIATE_TEST_SUITE_P(All, ShapeFunctions, testing::ValuesIn(all_cell_types),
                         [](const auto& type) { return std::string(name_of(type.param)); });

}  // namespace
}  // namespace evert
