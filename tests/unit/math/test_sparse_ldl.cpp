// The sparse factors against dense products, and matrices that have none.
#include "evert/math/sparse_ldl.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace evert {
namespace {

/// A sparse diagonally dominant matrix in several parts that are not connected, also dense.
struct Matrix {
  static constexpr SparseLdl::Index size = 120, part = 40;
  std::vector<SparseLdl::Entry> lower;
  std::vector<double> values, dense = std::vector<double>(size * size);

  explicit Matrix(unsigned seed) {
    std::mt19937_64 random(7);  // of the pattern, always the same
    std::mt19937_64 of_values(seed);
    std::uniform_real_distribution<double> chance(0, 1), value(-1, 1);
    for (SparseLdl::Index i = 0; i < size; ++i)
      for (SparseLdl::Index j = 0; j <= i; ++j) {
        if (i != j && (i / part != j / part || chance(random) > 0.1)) continue;
        const double entry = i == j ? 12 + value(of_values) : value(of_values);
        lower.push_back({i, j});
        values.push_back(entry);
        dense[static_cast<std::size_t>(i * size + j)] = dense[static_cast<std::size_t>(j * size + i)] = entry;
      }
  }
};

TEST(SparseLdl, SolvesWithEveryMatrixOfItsPattern) {
  SparseLdl ldl(Matrix::size, Matrix(0).lower);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Matrix matrix(seed);
    std::vector<double> b(Matrix::size);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(1.0 + static_cast<double>(i * (seed + 1)));
    ASSERT_TRUE(ldl.factor(matrix.values));
    auto x = b;
    ldl.solve(x);
    for (std::size_t i = 0; i < b.size(); ++i) {
      double product = 0;
      for (std::size_t j = 0; j < b.size(); ++j) product += matrix.dense[i * b.size() + j] * x[j];
      EXPECT_NEAR(product, b[i], 1e-14);
    }
  }
}

TEST(SparseLdl, FillsOnlyInsideOfParts) {
  const SparseLdl ldl(Matrix::size, Matrix(0).lower);
  EXPECT_GE(ldl.fill(), Matrix(0).lower.size() - Matrix::size);
  EXPECT_LE(ldl.fill(), std::size_t{3 * Matrix::part * (Matrix::part - 1) / 2});
}

TEST(SparseLdl, TellsThatAMatrixIsNotPositiveDefinite) {
  Matrix matrix(0);
  SparseLdl ldl(Matrix::size, matrix.lower);
  for (const double bad : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    matrix.values[0] = bad;  // the first of the diagonal
    EXPECT_FALSE(ldl.factor(matrix.values)) << bad;
  }
  EXPECT_TRUE(ldl.factor(Matrix(1).values));
}

TEST(SparseLdl, HasNothingToDoForNothing) {
  SparseLdl ldl(0, {});
  EXPECT_TRUE(ldl.factor({}));
  ldl.solve({});
}

}  // namespace
}  // namespace evert
