#include "evert/core/aligned.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace evert {
namespace {

template <class T>
std::uintptr_t address(const AlignedVector<T>& array) {
  return reinterpret_cast<std::uintptr_t>(array.data());
}

TEST(Aligned, SmallArraysStandOnCacheLinesAndLargeOnesOnHugePages) {
  EXPECT_EQ(address(AlignedVector<double>(1)) % 64, 0U);
  EXPECT_EQ(address(AlignedVector<float>(1000)) % 64, 0U);
  EXPECT_EQ(address(AlignedVector<double>(1 << 18)) % (1 << 21), 0U);
}

TEST(Aligned, ArraysKeepTheirValuesAsTheyGrowThroughAllSizes) {
  AlignedVector<int> array;
  for (int i = 0; i < 1'000'000; ++i) array.push_back(i);
  for (int i = 0; i < 1'000'000; ++i) ASSERT_EQ(array[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace evert
