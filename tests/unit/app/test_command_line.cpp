#include "evert/app/command_line.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

namespace evert {
namespace {

using Words = std::vector<std::string>;

/// The words that a shell makes of `line`.
Words in_a_shell(const std::string& line) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(("printf '%s\\001' " + line).c_str(), "r"),
                                                             pclose);
  Words words(1);
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get()))
    if (c == '\1')
      words.emplace_back();
    else
      words.back() += static_cast<char>(c);
  words.pop_back();
  return words;
}

TEST(RestartCommand, IsTheCommandLineWithTheCheckpoint) {
  const Words given{"my scenes/it's.yaml",
                    "--set",
                    "gravity=[0, -9.81, 0]",
                    "-set",
                    "bodies.a.damping={model: rotated, alpha: 1}",
                    "-output",
                    "out $HOME",
                    "-quiet",
                    "-restart",
                    "old.h5",
                    "-allow_unknown_options",
                    "-damping_ksp_rtol",
                    "1e-3",
                    "-damping_ksp_monitor"};
  const auto run = parse_run_arguments(given);
  const auto pasted = in_a_shell(restart_command(run, "out $HOME/checkpoint.h5"));
  ASSERT_GT(pasted.size(), 2U);
  EXPECT_EQ(Words(pasted.begin(), pasted.begin() + 2), (Words{"evert", "run"}));
  const auto again = parse_run_arguments(std::span(pasted).subspan(2));
  EXPECT_EQ(again.scene, run.scene);
  EXPECT_EQ(again.overrides, run.overrides);
  EXPECT_EQ(again.output, run.output);
  EXPECT_EQ(again.quiet, run.quiet);
  EXPECT_EQ(again.allow_unknown_options, run.allow_unknown_options);
  EXPECT_EQ(again.petsc, run.petsc);
  EXPECT_EQ(again.restart, "out $HOME/checkpoint.h5");
}

TEST(RestartCommand, LeavesPlainWordsPlain) {
  const auto run = parse_run_arguments(Words{"scene.yaml", "-set", "end_time=1e-3"});
  EXPECT_EQ(restart_command(run, "runs/a/checkpoint.h5"),
            "evert run scene.yaml -restart runs/a/checkpoint.h5 -set end_time=1e-3");
}

}  // namespace
}  // namespace evert
