#include "evert/bench/level_kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace evert::bench {
namespace {

TEST(LevelKernels, SvdOfAnyNumberOfMatrices) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  for (const std::size_t count : {1U, 2U, 7U, 8U, 64U, 67U}) {
    std::vector<Mat3d> f(count);
    for (auto& matrix : f)
      for (auto& column : matrix.column)
        for (double& entry : column.components) entry = normal(random);
    // One more, to see that nothing is written past the end.
    std::vector<Svd3<double>> result(count + 1);
    result.back().sigma = {-7, -7, -7};
    level_kernels().svd3(f.data(), result.data(), count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [u, sigma, v] = result[i];
      EXPECT_LE(norm(u * diagonal(sigma) * transpose(v) - f[i]), 1e-14 * norm(f[i]));
    }
    EXPECT_EQ(result.back().sigma, (Vec3d{-7, -7, -7}));
  }
}

TEST(LevelKernels, Triad) {
  const std::vector<double> b(24, 1.0);
  const std::vector<double> c(24, 3.0);
  std::vector<double> a(24, 0.0);
  level_kernels().triad(a.data(), b.data(), c.data(), 0.5, a.size());
  EXPECT_EQ(a, std::vector<double>(24, 2.5));
}

// x ← 0.999999 x + 1e-6 goes to 1, x ← √(1.3/x) to the cube root of 1.3: all chains of all lanes were run.
TEST(LevelKernels, ChainsConverge) {
  const auto& kernels = level_kernels();
  const double chains = kernels.flops_per_step / 2;
  EXPECT_NEAR(kernels.multiply_add(20'000'000) / chains, 1, 1e-6);
  EXPECT_NEAR(kernels.divide_and_root(200) / chains, std::cbrt(1.3), 1e-12);
  EXPECT_EQ(kernels.divisions_per_step, kernels.flops_per_step);
}

}  // namespace
}  // namespace evert::bench
