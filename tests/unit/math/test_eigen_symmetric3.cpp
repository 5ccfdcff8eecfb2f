#include "evert/math/eigen_symmetric3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace evert {
namespace {

void expect_decomposes(const Mat3d& a) {
  const SymmetricEigen3 eigen = eigen_symmetric3(a);
  const Mat3d rebuilt = times_transpose(eigen.vectors * diagonal(eigen.values), eigen.vectors);
  EXPECT_LE(norm(rebuilt - a), 1e-14 * norm(a));
  EXPECT_LE(norm(transpose_times(eigen.vectors, eigen.vectors) - identity<double>()), 1e-14);
  EXPECT_LE(eigen.values[0], eigen.values[1]);
  EXPECT_LE(eigen.values[1], eigen.values[2]);
}

TEST(EigenSymmetric3, DecomposesRandomAndDegenerateMatrices) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 2000; ++k) {
    Mat3d a;
    for (auto& column : a.column) {
      for (double& entry : column.components) entry = normal(random);
    }
    expect_decomposes(a + transpose(a));
    expect_decomposes(outer(a.column[0], a.column[0]));
  }
  expect_decomposes(Mat3d{});
  expect_decomposes(identity<double>());
  expect_decomposes(1e100 * diagonal<double>({3, -1, 2}));
}

TEST(EigenSymmetric3, ReadsTheLowerTriangle) {
  Mat3d a = diagonal<double>({1, 2, 3});
  a(0, 2) = 1e9;
  EXPECT_EQ(eigen_symmetric3(a).values, (Vec3d{1, 2, 3}));
}

TEST(EigenSymmetric3, GivesNaNForNonFiniteInput) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mat3d a = identity<double>();
    a(1, 0) = bad;
    const SymmetricEigen3 eigen = eigen_symmetric3(a);
    EXPECT_TRUE(std::isnan(eigen.values[0]));
    EXPECT_TRUE(std::isnan(eigen.vectors(2, 2)));
  }
}

}  // namespace
}  // namespace evert
