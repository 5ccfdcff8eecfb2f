#include "evert/bench/sampling.hpp"

#include "evert/core/collective.hpp"

#include <gtest/gtest.h>

#include <array>

namespace evert::bench {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// Some microseconds of work, more on the higher ranks.
void work() {
  volatile double sum = 0;
  for (int i = 0; i < 3000 * (1 + rank_of(world)); ++i) sum = sum + i;
}

/// Two workloads that write down their calls.
struct Diary {
  std::vector<std::size_t> calls;
  std::array<Workload, 2> workloads{Workload{1000,
                                             [this] {
                                               calls.push_back(0);
                                               work();
                                             }},
                                    Workload{3000, [this] {
                                               calls.push_back(1);
                                               work();
                                               work();
                                               work();
                                             }}};

  /// Whose turn it was, one entry for all calls of a turn.
  [[nodiscard]] std::vector<std::size_t> turns() const {
    std::vector<std::size_t> result;
    for (const auto call : calls)
      if (result.empty() || result.back() != call) result.push_back(call);
    return result;
  }
};

TEST(Sampling, TakesTurns) {
  Diary diary;
  const auto measured = measure(world, diary.workloads, 0.05);
  // The warm-up is a turn of each too.
  EXPECT_EQ(diary.turns().size(), 2 * static_cast<std::size_t>(measured.rounds + 1));
}

TEST(Sampling, TakesAFewSamplesInNoTime) {
  Diary diary;
  EXPECT_EQ(measure(world, diary.workloads, 1e-9).rounds, 5);
}

TEST(Sampling, RanksAgree) {
  Diary diary;
  const auto measured = measure(world, diary.workloads, 0.02);
  std::vector<double> mine{static_cast<double>(measured.rounds), static_cast<double>(diary.calls.size())};
  for (const auto& rate : measured.rates) mine.insert(mine.end(), {rate.best, rate.median});
  auto of_root = mine;
  MPI_Bcast(of_root.data(), static_cast<int>(of_root.size()), MPI_DOUBLE, 0, world);
  EXPECT_EQ(mine, of_root);
}

TEST(Sampling, RatesAreItemsOverTime) {
  Diary diary;
  auto many = diary.workloads;
  for (auto& workload : many) workload.items = 1e300;  // no machine is as fast
  const auto measured = measure(world, many, 0.01);
  for (const auto& rate : measured.rates) {
    EXPECT_GT(rate.median, 1e300);  // a call takes less than a second
    EXPECT_LT(rate.best, 1e308);    // and more than 10 ns
    EXPECT_GE(rate.best, rate.median);
  }
}

}  // namespace
}  // namespace evert::bench
