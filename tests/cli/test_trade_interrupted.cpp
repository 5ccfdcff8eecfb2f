// Sweeps that are killed or asked to stop, and go on.
#include <gtest/gtest.h>

#include "case.hpp"
#include "program.hpp"
#include <csignal>
#include <fstream>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>

extern char** environ;

namespace evert::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// 6 settings and two finer runs, the coarsest of the reference being one of the grid.
const std::vector<std::string> sweep{
    "trade",   "scene.yaml", "-vary", "integrator.time_step=1e-4,2e-4,4e-4,6e-4,8e-4,1e-3",
    "-repeat", "1",          "-out",  "t"};
constexpr std::size_t all_runs = 8, enough = 4;

class InterruptedSweep : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    fs::create_directories(place_);
    std::ofstream(place_ / "scene.yaml") << scene({{"end_time: 2e-3", "end_time: 0.2"}}).content;
  }
  void TearDown() override { fs::remove_all(place_); }

  [[nodiscard]] std::size_t runs_kept() const {
    std::size_t count = 0;
    if (!fs::exists(place_ / "t/runs")) return 0;
    for (const auto& entry : fs::directory_iterator(place_ / "t/runs"))
      count += entry.path().extension() == ".h5" ? 1 : 0;
    return count;
  }

  /// Sends the signal once some runs are kept; what the program ends with.
  int interrupt(int signal) const {
    std::vector<std::string> words{
        "/bin/sh", "-c", "cd " + place_.string() + " && exec \"$0\" \"$@\" >out.txt 2>&1", EVERT_PROGRAM};
    words.insert(words.end(), sweep.begin(), sweep.end());
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t program = 0;
    EXPECT_EQ(posix_spawn(&program, "/bin/sh", nullptr, nullptr, arguments.data(), environ), 0);
    for (int i = 0; i < 6000 && runs_kept() < enough; ++i) std::this_thread::sleep_for(10ms);
    kill(program, signal);
    int status = 0;
    waitpid(program, &status, 0);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

  const fs::path place_ = fs::temp_directory_path() / ("evert_interrupted_" + std::to_string(getpid()));
};

TEST_P(InterruptedSweep, GoesOnWithWhatIsThere) {
  EXPECT_EQ(interrupt(GetParam()), GetParam() == SIGKILL ? 137 : 130);
  const auto kept = runs_kept();
  ASSERT_GE(kept, enough);
  ASSERT_LT(kept, all_runs) << "it had ended before it was interrupted";
  EXPECT_FALSE(fs::exists(place_ / "t/trade.csv"));
  const auto again = run_evert(sweep, 1, place_, 90s);
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_NE(again.output.find("\n" + std::to_string(all_runs - kept) + " simulations made"),
            std::string::npos)
      << kept << " were kept\n"
      << again.output;
  EXPECT_EQ(runs_kept(), all_runs);
}

INSTANTIATE_TEST_SUITE_P(Signals, InterruptedSweep, testing::Values(SIGKILL, SIGTERM),
                         [](const auto& signal) { return signal.param == SIGKILL ? "kill" : "term"; });

}  // namespace
}  // namespace evert::cli
