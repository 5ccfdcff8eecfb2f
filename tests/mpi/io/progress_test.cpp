#include "evert/io/progress.hpp"

#include "evert/core/collective.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"
#include <array>
#include <string>

namespace evert {
namespace {

using namespace std::chrono_literals;

const MPI_Comm world = MPI_COMM_WORLD;
const Progress::Clock::time_point begin{};

/// What is written to a stream while it lives.
class Captured {
 public:
  Captured() : file_(std::tmpfile()) {}
  ~Captured() { std::fclose(file_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  [[nodiscard]] std::FILE* file() const { return file_; }
  [[nodiscard]] std::string text() const {
    std::rewind(file_);
    std::array<char, 4096> bytes{};
    return {bytes.data(), std::fread(bytes.data(), 1, bytes.size(), file_)};
  }

 private:
  std::FILE* file_;
};

std::string on_rank_0(const std::string& text) { return rank_of(world) == 0 ? text : ""; }

TEST(Progress, LinesTellTimeStepsRateRemainingInversionAndIterations) {
  const Captured out;
  Progress progress(world, ProgressStyle::lines, {}, 2.0, out.file(), begin);
  progress.show({0.5, 100, 7, 450}, begin + 10s);
  progress.show({1.0, 300, 0, 1050}, begin + 20s);
  progress.finish({2.0, 500, 0, 1450}, begin + 30s);
  EXPECT_EQ(out.text(),
            on_rank_0(" 25 %  t = 0.5 of 2 s  100 steps, 10/s  30 s left  7 inverted  CG 4.5/step\n"
                      " 50 %  t = 1 of 2 s  300 steps, 20/s  20 s left  0 inverted  CG 3.0/step\n"
                      "100 %  t = 2 of 2 s  500 steps, 20/s  in 30 s  0 inverted  CG 2.0/step\n"));
}

TEST(Progress, ARestartCountsOnlyItsOwnPace) {
  const Captured out;
  Progress progress(world, ProgressStyle::lines, {1.0, 1000, 0, 0}, 2.0, out.file(), begin);
  progress.show({1.5, 1010, 0, 10}, begin + 60s);
  EXPECT_EQ(
      out.text(),
      on_rank_0(" 75 %  t = 1.5 of 2 s  1010 steps, 0.167/s  1 min 0 s left  0 inverted  CG 1.0/step\n"));
}

TEST(Progress, SaysNothingOfIterationsWhereNothingIsSolved) {
  const Captured out;
  Progress progress(world, ProgressStyle::lines, {}, 2.0, out.file(), begin);
  progress.show({1.0, 10, 0, 0}, begin + 1s);
  EXPECT_EQ(out.text(), on_rank_0(" 50 %  t = 1 of 2 s  10 steps, 10/s  1 s left  0 inverted\n"));
}

TEST(Progress, ATerminalLineIsWrittenOverAndEndsOnce) {
  const Captured out;
  Progress progress(world, ProgressStyle::rewriting, {}, 2.0, out.file(), begin);
  progress.show({1.0, 0, 0, 0}, begin + 1s);
  progress.finish({2.0, 0, 0, 0}, begin + 2s);
  EXPECT_EQ(out.text(), on_rank_0("\r 50 %  t = 1 of 2 s  0 steps  1 s left  0 inverted\x1b[K"
                                  "\r100 %  t = 2 of 2 s  0 steps  in 2 s  0 inverted\x1b[K\n"));
}

TEST(Progress, SilentSaysNothing) {
  const Captured out;
  Progress progress(world, ProgressStyle::silent, {}, 2.0, out.file(), begin);
  EXPECT_FALSE(progress.due(begin + 1h));
  progress.show({1.0, 10, 0, 0}, begin + 1s);
  progress.finish({2.0, 20, 0, 0}, begin + 2s);
  EXPECT_EQ(out.text(), "");
}

TEST(Progress, IsDueByTheClockOfRankZeroOnEveryRank) {
  const Captured out;
  Progress progress(world, ProgressStyle::lines, {}, 2.0, out.file(), begin);
  EXPECT_FALSE(progress.due(begin + (rank_of(world) == 0 ? 1s : 100s)));
  EXPECT_TRUE(progress.due(begin + (rank_of(world) == 0 ? 100s : 1s)));
  progress.show({}, begin + 100s);
  EXPECT_FALSE(progress.due(begin + 101s));
}

TEST(Progress, TheStyleOfRankZeroCounts) {
  const Captured out;
  const auto style = rank_of(world) == 0 ? ProgressStyle::silent : ProgressStyle::lines;
  const Progress progress(world, style, {}, 2.0, out.file(), begin);
  EXPECT_FALSE(progress.due(begin + 1h));
}

TEST(Progress, QuietIsSilent) { EXPECT_EQ(progress_style(true), ProgressStyle::silent); }

TEST(DurationText, PicksTwoUnits) {
  EXPECT_EQ(duration_text(0), "0 s");
  EXPECT_EQ(duration_text(-1), "0 s");
  EXPECT_EQ(duration_text(59.2), "1 min 0 s");
  EXPECT_EQ(duration_text(3599), "59 min 59 s");
  EXPECT_EQ(duration_text(3600), "1 h 0 min");
  EXPECT_EQ(duration_text(90061), "1 d 1 h");
  EXPECT_EQ(duration_text(1e300), "?");
  EXPECT_EQ(duration_text(std::numeric_limits<double>::quiet_NaN()), "?");
}

}  // namespace
}  // namespace evert
