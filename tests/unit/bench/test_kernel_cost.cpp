#include "evert/bench/kernel_cost.hpp"

#include <gtest/gtest.h>

namespace evert::bench {
namespace {

const Material neo_hookean = NeoHookean{.lame = {1, 1}};

// By hand, for one tetrahedron: differences of velocities 9, L = Σ v_a h_aᵀ 27 + 18, S 16, three products S
// h_a of 15, balance and sums into the nodes 9 + 12. Nine numbers of state and four node numbers.
TEST(KernelCost, OfTheDampingProductIsThatCountedByHand) {
  const auto cost = damping_cost(CellType::tet4, DampingModel::rotated);
  EXPECT_EQ(cost.flops, 9 + 45 + 16 + 45 + 21);
  EXPECT_EQ(cost.divisions, 0);
  EXPECT_EQ(cost.bytes, 9 * 8 + 4 * 4);
}

TEST(KernelCost, OfDampingStateIsNineNumbersMoreWrittenAndLineRead) {
  const auto plain = force_cost(CellType::tet4, neo_hookean);
  const auto damped = force_cost(CellType::tet4, neo_hookean, DampingModel::rotated);
  EXPECT_EQ(damped.bytes - plain.bytes, 2 * 9 * 8);
  EXPECT_GT(damped.flops, plain.flops);
}

// Every force needs an SVD, whose stages without U and V take more than two hundred operations.
TEST(KernelCost, OfForcesIsThatOfAnSvdAndMore) {
  for (const auto type : {CellType::tet4, CellType::hex8}) {
    const auto cost = force_cost(type, neo_hookean);
    EXPECT_GT(cost.flops, 300);
    EXPECT_LT(cost.flops, 1000);
    EXPECT_GT(cost.divisions, 8);
  }
}

TEST(KernelCost, KnowsTheMaterial) {
  const auto matrix = force_cost(CellType::tet4, MooneyRivlin{.lame = {1, 1}});
  const auto muscle = force_cost(CellType::tet4, Muscle{.lame = {1, 1}});
  EXPECT_EQ(muscle.bytes - matrix.bytes, 3 * 8);  // the direction
  EXPECT_GT(muscle.flops, matrix.flops);
}

}  // namespace
}  // namespace evert::bench
