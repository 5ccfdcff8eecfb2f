#include <gtest/gtest.h>

#include "cpu_levels.hpp"
#include "svd3_families.hpp"
#include "svd3_judge.hpp"
#include "tests/support/thorough.hpp"
#include <iostream>

namespace evert::test {
namespace {

/// The awkward families: two faults of a prototype showed only among tens of millions of matrices, which
/// EVERT_THOROUGH=1 tries on every CPU level.
TEST(Svd3Adversary, FindsNothing) {
  constexpr std::size_t chunk = 1 << 13;
  const std::size_t chunks_per_family = (thorough() ? 40'000'000 : 4'000'000) / (chunk * 14);
  MatrixArray matrices(chunk);
  for (const LevelKernels* level : runnable_levels()) {
    for (const Family& family : families()) {
      Random random(99);
      Verdict verdict;
      for (std::size_t k = 0; k < chunks_per_family; ++k) {
        for (std::size_t i = 0; i < chunk; ++i) matrices.set(i, family.sample(random));
        verdict.merge(judge(*level, matrices));
      }
      SCOPED_TRACE(std::string(level->name) + " " + std::string(family.name));
      expect_accurate(verdict, 1e-14L);
      std::cout << level->name << ' ' << family.name << ": " << static_cast<double>(verdict.largest_error())
                << '\n';
    }
  }
}

}  // namespace
}  // namespace evert::test
