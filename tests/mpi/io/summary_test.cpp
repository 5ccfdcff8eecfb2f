#include "evert/io/summary.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "scratch.hpp"
#include <limits>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

RunSummary some_summary() {
  RunSummary summary;
  summary.scene = "a \"quoted\" \\ name\nof two lines";
  summary.outcome = "finished";
  summary.nodes = 11;
  summary.cells = 8;
  summary.steps = 1234567890123;
  summary.simulated_time = 0.1;
  summary.wall_time = 12.5;
  summary.max_inverted_points = 5;
  summary.max_inverted_time = 0.05;
  summary.final_state.kinetic_energy = 1.5;
  summary.final_state.elastic_energy = std::numeric_limits<double>::quiet_NaN();
  summary.final_state.momentum = {1, 2, 3};
  summary.phases.mean.back() = 0.25;
  summary.phases.max.back() = 0.5;
  summary.cpu_level = "x86-64-v3";
  return summary;
}

TEST(Summary, IsJsonWithEverythingInIt) {
  const test::Scratch scratch;
  write_summary(world, scratch / "summary.json", some_summary());
  const auto json = YAML::Load(test::content_of(scratch / "summary.json"));  // JSON is YAML
  EXPECT_EQ(json["scene"].as<std::string>(), some_summary().scene);
  EXPECT_EQ(json["steps"].as<std::int64_t>(), 1234567890123);
  EXPECT_EQ(json["ranks"].as<int>(), size_of(world));
  EXPECT_EQ(json["simulated_seconds"].as<double>(), 0.1);
  EXPECT_EQ(json["max_inverted"]["points"].as<int>(), 5);
  EXPECT_EQ(json["final"]["kinetic_energy"].as<double>(), 1.5);
  EXPECT_TRUE(json["final"]["elastic_energy"].IsNull());
  EXPECT_EQ(json["final"]["momentum"].as<std::vector<double>>(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(json["phase_seconds"]["io"]["mean"].as<double>(), 0.25);
  EXPECT_EQ(json["phase_seconds"]["io"]["max"].as<double>(), 0.5);
  for (const auto* library : {"evert", "petsc", "mpi", "hdf5"})
    EXPECT_NE(json["versions"][library].as<std::string>(), "") << library;
}

TEST(Summary, GivesThePeakMemoryOfEachRank) {
  const test::Scratch scratch;
  write_summary(world, scratch / "summary.json", some_summary());
  const auto memory = YAML::Load(test::content_of(scratch / "summary.json"))["peak_memory_bytes"];
  ASSERT_EQ(memory.size(), static_cast<std::size_t>(size_of(world)));
  for (const auto& bytes : memory) EXPECT_GT(bytes.as<std::int64_t>(), 1 << 20);
}

TEST(Summary, WhatCannotBeWrittenIsAnErrorOnEveryRank) {
  const test::Scratch scratch;
  const auto path = scratch / "none/summary.json";
  EXPECT_EQ(test::user_error_of([&] { write_summary(world, path, some_summary()); }),
            "cannot write '" + path + ".tmp': No such file or directory");
}

TEST(PeakMemory, GrowsWithWhatIsUsed) {
  const auto before = peak_memory();
  const std::vector<char> block(100 << 20, 1);
  EXPECT_GE(peak_memory(), std::min<std::int64_t>(before + (50 << 20), before + block.size() / 2));
}

}  // namespace
}  // namespace evert
