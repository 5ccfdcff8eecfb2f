#include <gtest/gtest.h>

#include "case.hpp"
#include "program.hpp"
#include <fstream>
#include <sys/mount.h>

/// Every case of the table at every number of its ranks, in a fresh directory.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::seconds limit{90};

struct Run {
  const Case* what;
  int ranks;
};

std::vector<Run> all_runs() {
  std::vector<Run> runs;
  for (const auto& one : all_cases())
    for (const int ranks : one.ranks) runs.push_back({&one, ranks});
  return runs;
}

std::string name_of(const Run& run) { return run.what->name + "_np" + std::to_string(run.ranks); }

/// For GoogleTest's messages.
void PrintTo(const Run& run, std::ostream* out) { *out << name_of(run); }

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + '\n';
  return text;
}

void expect_says(const std::string& text, const std::vector<std::string>& parts) {
  for (const auto& part : parts) EXPECT_NE(text.find(part), std::string::npos) << "says nothing of: " << part;
}

class Cli : public testing::TestWithParam<Run> {
 protected:
  void SetUp() override {
    fs::remove_all(place_);
    fs::create_directories(place_);
    for (const auto& file : what_.files) write(file);
  }

  void TearDown() override {
    if (mounted_) umount2((place_ / "disk").c_str(), MNT_DETACH);
    fs::remove_all(place_);
  }

  void write(const File& file) const {
    if (file.path.ends_with('/'))
      fs::create_directories(place_ / file.path);
    else
      std::ofstream(place_ / file.path, std::ios::binary) << file.content;
  }

  /// False where nothing may be mounted here.
  bool mount_disk(int kib) {
    fs::create_directory(place_ / "disk");
    const auto size = "size=" + std::to_string(kib) + "k";
    mounted_ = mount("tmpfs", (place_ / "disk").c_str(), "tmpfs", 0, size.c_str()) == 0;
    return mounted_;
  }

  [[nodiscard]] Outcome run(const std::string& command) const {
    return run_evert(split(command), ranks_, place_, limit);
  }

  const Case& what_ = *GetParam().what;
  const int ranks_ = GetParam().ranks;
  const fs::path place_ =
      fs::temp_directory_path() / ("evert_cli_" + std::to_string(getpid()) + "_" + name_of(GetParam()));
  bool mounted_ = false;
};

TEST_P(Cli, Ends) {
  if (what_.disk_kib && !mount_disk(*what_.disk_kib)) GTEST_SKIP() << "no file system may be mounted here";
  if (!what_.before.empty()) {
    const auto first = run(what_.before);
    ASSERT_EQ(first.exit_code, 0) << first.output << joined(first.errors);
  }
  if (what_.spoil) what_.spoil(place_);

  const auto outcome = run(what_.command);
  SCOPED_TRACE("evert " + what_.command + "\n--- output\n" + outcome.output + "--- errors\n" +
               joined(outcome.errors));
  EXPECT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.exit_code, what_.exit_code);
  if (what_.exit_code == 0) {
    EXPECT_TRUE(outcome.errors.empty());
    expect_says(outcome.output, what_.says);
  } else {
    ASSERT_EQ(outcome.errors.size(), 1) << "one line on standard error, from one rank";
    EXPECT_TRUE(outcome.errors[0].starts_with("evert: "));
    expect_says(outcome.errors[0], what_.says);
  }
  if (what_.inspect) what_.inspect(place_);
}

INSTANTIATE_TEST_SUITE_P(All, Cli, testing::ValuesIn(all_runs()),
                         [](const auto& parameter) { return name_of(parameter.param); });

}  // namespace
}  // namespace evert::cli
