#include "evert/core/log.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace evert {
namespace {

double seconds(Phase phase) { return phase_seconds()[static_cast<std::size_t>(phase)]; }

void pass(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// A sleep lasts at least as long as asked, and on a busy machine any time longer: what is compared are sums
// of the phases with the time around them, and each with what it slept at least.
TEST(PhaseScope, PhasesAreExclusive) {
  const auto before = phase_seconds();
  const double begin = MPI_Wtime();
  {
    const PhaseScope solve(Phase::damping_solve);
    pass(0.01);
    {
      const PhaseScope apply(Phase::damping_apply);
      pass(0.02);
      const PhaseScope halo(Phase::halo);
      pass(0.04);
    }
    pass(0.01);
  }
  const double wall = MPI_Wtime() - begin;
  const auto spent = [&](Phase phase) { return seconds(phase) - before[static_cast<std::size_t>(phase)]; };
  EXPECT_GE(spent(Phase::damping_solve), 0.02);
  EXPECT_GE(spent(Phase::damping_apply), 0.02);
  EXPECT_GE(spent(Phase::halo), 0.04);
  double sum = 0;
  for (std::size_t phase = 0; phase < phase_count; ++phase) sum += spent(static_cast<Phase>(phase));
  EXPECT_LE(sum, wall);
}

TEST(PhaseScope, APhaseInsideItselfCountsOnce) {
  const double before = seconds(Phase::io);
  const double begin = MPI_Wtime();
  {
    const PhaseScope outer(Phase::io);
    const PhaseScope inner(Phase::io);
    pass(0.02);
  }
  const double spent = seconds(Phase::io) - before;
  EXPECT_GE(spent, 0.02);
  EXPECT_LE(spent, MPI_Wtime() - begin);
}

TEST(PhaseScope, TimeOutsideAllPhasesIsBookedToNone) {
  { const PhaseScope scope(Phase::contact); }
  const auto before = phase_seconds();
  pass(0.02);
  const double begin = MPI_Wtime();
  { const PhaseScope scope(Phase::force); }
  const double wall = MPI_Wtime() - begin;
  EXPECT_EQ(seconds(Phase::contact), before[static_cast<std::size_t>(Phase::contact)]);
  EXPECT_LE(seconds(Phase::force) - before[static_cast<std::size_t>(Phase::force)], wall);
}

}  // namespace
}  // namespace evert
