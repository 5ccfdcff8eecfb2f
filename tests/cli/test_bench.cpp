#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "program.hpp"
#include <unistd.h>

/// `evert bench` as programs see it. Figures are only looked at for being there: timings gate nothing.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::seconds limit{300};

class Bench : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { fs::create_directories(place_); }
  void TearDown() override { fs::remove_all(place_); }

  const fs::path place_ = fs::temp_directory_path() /
                          ("evert_bench_" + std::to_string(getpid()) + "_np" + std::to_string(GetParam()));
};

void expect_rate(const YAML::Node& rate, const std::string& key) {
  ASSERT_TRUE(rate["best"] && rate["median"]) << key;
  EXPECT_GT(rate["median"].as<double>(), 0) << key;
  EXPECT_GE(rate["best"].as<double>(), rate["median"].as<double>()) << key;
}

TEST_P(Bench, WritesWhatItMeasures) {
  const auto outcome =
      run_evert(split("bench kernels -bench_size small -bench_seconds 0.01 -bench_json out/bench.json"),
                GetParam(), place_, limit);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output << (outcome.errors.empty() ? "" : outcome.errors[0]);
  EXPECT_NE(outcome.output.find("small: 1296 tets"), std::string::npos) << outcome.output;

  const auto json = YAML::LoadFile(place_ / "out/bench.json");  // JSON is YAML
  EXPECT_EQ(json["ranks"].as<int>(), GetParam());
  for (const char* key : {"date", "machine", "cpu_level"})
    EXPECT_FALSE(json[key].as<std::string>().empty()) << key;
  for (const char* key : {"tet_force_mps", "tet_force_damped_mps", "hex_force_mqps", "general_path_mqps",
                          "tet_muscle_mps", "tet_spline_mps", "hex_tendon_mqps", "tet_stable_neo_hookean_mps",
                          "svd_mps", "damping_mtps", "damping_matmult_mtps", "baij_matmult_mtps",
                          "tet_filtered_neo_hookean_mps", "tet_filtered_rotated_linear_mps",
                          "naive_tet_force_mps", "multiply_add_gflops", "division_gps", "triad_gbs"})
    expect_rate(json[key]["small"], key);
  for (const char* group : {"multiple_of_naive", "share_of_ceiling"})
    EXPECT_GT(json[group]["small"]["tet_force_mps"].as<double>(), 0) << group;
  EXPECT_GT(json["filtered_cost"]["small"]["rotated_linear"].as<double>(), 0);
  EXPECT_GT(json["multiple_of_baij"]["small"]["damping_mtps"].as<double>(), 0);
  EXPECT_GT(json["sizes"]["small"]["inverted_share"].as<double>(), 0);
}

TEST_P(Bench, ComparesElements) {
  const auto outcome = run_evert(split("bench elements -bench_size small -bench_seconds 0.01 -bench_json "
                                       "out/elements.json -bench_svg out/elements.svg"),
                                 GetParam(), place_, limit);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output << (outcome.errors.empty() ? "" : outcome.errors[0]);
  const auto json = YAML::LoadFile(place_ / "out/elements.json");
  ASSERT_EQ(json["elements"].size(), 6U);
  for (const auto& element : json["elements"]) {
    const auto kind = element["kind"].as<std::string>();
    EXPECT_GT(element["force_seconds"].as<double>(), 0) << kind;
    EXPECT_GT(element["stable_step"].as<double>(), 0) << kind;
    EXPECT_LT(element["error"].as<double>(), 0) << kind << " is too stiff";
  }
  EXPECT_EQ(json["locking"].size(), 4U);
  EXPECT_TRUE(fs::file_size(place_ / "out/elements.svg") > 1000);
}

INSTANTIATE_TEST_SUITE_P(Ranks, Bench, testing::Values(1, 2),
                         [](const auto& parameter) { return "np" + std::to_string(parameter.param); });

}  // namespace
}  // namespace evert::cli
