#include "evert/materials/stress_measures.hpp"

#include <gtest/gtest.h>

namespace evert {
namespace {

const Mat3d f{{{{1.2, 0.3, -0.1}, {0.2, 0.7, 0.4}, {-0.5, 0.1, -0.9}}}};  // inverted
const Mat3d symmetric{{{{3, 1, -2}, {1, 5, 0.5}, {-2, 0.5, -4}}}};

TEST(StressMeasures, OfMatricesAreInverses) {
  const Mat3d by_cauchy = first_piola_kirchhoff_from_cauchy(f, symmetric);
  EXPECT_LT(norm(by_cauchy - determinant(f) * symmetric * transpose(inverse(f))), 1e-14);
  EXPECT_LT(norm(cauchy_from_first_piola_kirchhoff(f, by_cauchy) - symmetric), 1e-14);
  const Mat3d by_second = first_from_second_piola_kirchhoff(f, symmetric);
  EXPECT_LT(norm(second_from_first_piola_kirchhoff(f, by_second) - symmetric), 1e-14);
}

TEST(StressMeasures, OfPrincipalValuesAreThoseOfDiagonalMatrices) {
  const Vec3d sigma{1.4, 0.6, -0.3}, s{2, -1, 3};
  const auto same = [](const Vec3d& values, const Mat3d& matrix) {
    EXPECT_LT(norm(diagonal(values) - matrix), 1e-14);
  };
  const Mat3d stretch = diagonal(sigma), stress = diagonal(s);
  same(first_from_second_piola_kirchhoff(sigma, s), first_from_second_piola_kirchhoff(stretch, stress));
  same(first_piola_kirchhoff_from_cauchy(sigma, s), first_piola_kirchhoff_from_cauchy(stretch, stress));
  same(second_from_first_piola_kirchhoff(sigma, s), second_from_first_piola_kirchhoff(stretch, stress));
  same(cauchy_from_first_piola_kirchhoff(sigma, s), cauchy_from_first_piola_kirchhoff(stretch, stress));
}

TEST(StressMeasures, ToTheFirstAreFiniteWhereFlat) {
  const Mat3d flat = diagonal<double>({1, 2, 0});
  EXPECT_EQ(first_piola_kirchhoff_from_cauchy(flat, symmetric)(2, 2), -8);
  EXPECT_EQ(first_from_second_piola_kirchhoff(flat, symmetric)(2, 2), 0);
}

}  // namespace
}  // namespace evert
