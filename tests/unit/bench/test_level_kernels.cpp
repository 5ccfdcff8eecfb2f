#include "evert/bench/level_kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace evert::bench {
namespace {

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
