#include "evert/bench/kernel_cost.hpp"

#include <gtest/gtest.h>

namespace evert::bench {
namespace {

// By hand, for one tetrahedron: differences of velocities 9, L = Σ v_a h_aᵀ 27 + 18, S 16, three products S
// h_a of 15, balance and sums into the nodes 9 + 12. Nine numbers of state and four node numbers.
TEST(KernelCost, OfTheDampingProductIsThatCountedByHand) {
  const auto cost = damping_cost();
  EXPECT_EQ(cost.flops, 9 + 45 + 16 + 45 + 21);
  EXPECT_EQ(cost.divisions, 0);
  EXPECT_EQ(cost.bytes, 9 * 8 + 4 * 4);
}

TEST(KernelCost, OfDampingStateIsNineNumbersMoreWrittenAndLineRead) {
  const auto plain = force_cost(CellType::tet4, DampingModel::none);
  const auto damped = force_cost(CellType::tet4, DampingModel::rotated);
  EXPECT_EQ(damped.bytes - plain.bytes, 2 * 9 * 8);
  EXPECT_GT(damped.flops, plain.flops);
}

// Every force needs an SVD, whose stages without U and V take more than two hundred operations.
TEST(KernelCost, OfForcesIsThatOfAnSvdAndMore) {
  for (const auto type : {CellType::tet4, CellType::hex8}) {
    const auto cost = force_cost(type, DampingModel::none);
    EXPECT_GT(cost.flops, 300);
    EXPECT_LT(cost.flops, 1000);
    EXPECT_GT(cost.divisions, 8);
  }
}

}  // namespace
}  // namespace evert::bench
