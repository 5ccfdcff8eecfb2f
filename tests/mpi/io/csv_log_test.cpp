#include "evert/io/csv_log.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"
#include <algorithm>
#include <limits>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

Measurements some_measurements() {
  Measurements m;
  m.kinetic_energy = 0.1;
  m.elastic_energy = 2;
  m.gravitational_energy = -1e-300;
  m.momentum = {1, 2, 3};
  m.angular_momentum = {4, 5, 6};
  m.gravity_impulse = {7, 8, 9};
  m.contact_impulse = {10, 11, 12};
  m.constraint_impulse = {13, 14, 15};
  m.damping_impulse = {16, 17, 18};
  m.inverted_points = 99;
  return m;
}

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream text(test::content_of(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// A log with rows at 0, 0.5, 1, 1.5 s.
void write_four_rows(const std::string& path) {
  EnergyLog log(world, path);
  for (int row = 0; row < 4; ++row) log.write(10 * row, 0.5 * row, some_measurements());
}

TEST(EnergyLog, HeadsColumnsByNameAndUnit) {
  const test::Scratch scratch;
  const EnergyLog log(world, scratch / "energy.csv");
  EXPECT_TRUE(lines_of(scratch / "energy.csv")[0].starts_with(
      "time [s],step,kinetic_energy [J],elastic_energy [J],"));
}

TEST(EnergyLog, ARowHasAValueForEachColumnAndIsThereAtOnce) {
  const test::Scratch scratch;
  EnergyLog log(world, scratch / "energy.csv");
  log.write(7, 0.3, some_measurements());
  const auto lines = lines_of(scratch / "energy.csv");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1], "0.3,7,0.1,2,-1e-300,2.1,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,99");
  EXPECT_EQ(std::count(lines[0].begin(), lines[0].end(), ','),
            std::count(lines[1].begin(), lines[1].end(), ','));
}

TEST(EnergyLog, ContinuesWithoutLaterRows) {
  const test::Scratch scratch;
  const auto path = scratch / "energy.csv";
  write_four_rows(path);
  auto log = EnergyLog::continue_from(world, path, 1.0);
  log.write(25, 1.25, some_measurements());
  const auto lines = lines_of(path);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_TRUE(lines[3].starts_with("1,20,"));
  EXPECT_TRUE(lines[4].starts_with("1.25,25,"));
}

TEST(EnergyLog, ContinuesWithoutARowThatAKillCutShort) {
  const test::Scratch scratch;
  const auto path = scratch / "energy.csv";
  write_four_rows(path);
  MPI_Barrier(world);
  if (rank_of(world) == 0) std::filesystem::resize_file(path, std::filesystem::file_size(path) - 5);
  MPI_Barrier(world);
  { const auto log = EnergyLog::continue_from(world, path, 100); }
  EXPECT_EQ(lines_of(path).size(), 4U);
}

TEST(EnergyLog, ContinuesWhereThereIsNoneByBeginning) {
  const test::Scratch scratch;
  const auto log = EnergyLog::continue_from(world, scratch / "new/energy.csv", 1);
  EXPECT_EQ(lines_of(scratch / "new/energy.csv").size(), 1U);
}

TEST(EnergyLog, DoesNotContinueOtherFiles) {
  const test::Scratch scratch;
  const auto path = scratch / "energy.csv";
  if (rank_of(world) == 0) std::ofstream(path) << "a,b,c\n1,2,3\n";
  MPI_Barrier(world);
  EXPECT_EQ(test::user_error_of([&] { static_cast<void>(EnergyLog::continue_from(world, path, 1)); }),
            "cannot continue '" + path + "': it is not a log with the columns of this evert");
  EXPECT_EQ(lines_of(path).size(), 2U);
}

TEST(ObstacleLog, GivesImpulsesAndTheMeanForceSinceTheRowBefore) {
  const test::Scratch scratch;
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(std::make_unique<Obstacle>(
      "belt", 0.1, std::make_unique<HalfSpace>(Vec3d{}, Vec3d{0, 1, 0}),
      std::make_unique<UniformMotion>(RigidState{.origin = {5, 0, 0}, .velocity = {1, 2, 3}})));
  ObstacleLog log(world, scratch / "obstacles.csv", obstacles);
  log.write(0, 0, obstacles, std::vector<ObstacleImpulse>{{}});
  log.write(7, 0.5, obstacles, std::vector<ObstacleImpulse>{{{1, 2, 3}, {4, 5, 6}}});
  const auto lines = lines_of(scratch / "obstacles.csv");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(lines[0].starts_with("time [s],step,belt.impulse_x [N s],belt.impulse_y [N s],"));
  EXPECT_EQ(lines[2], "0.5,7,1,2,3,4,5,6,2,4,6,5,0,0,1,2,3,0,0,0");
  auto again = ObstacleLog::continue_from(world, scratch / "obstacles.csv", obstacles, 0);
  again.begin_at(0, std::vector<ObstacleImpulse>{{}});
  again.write(3, 0.25, obstacles, std::vector<ObstacleImpulse>{{{1, 0, 0}, {}}});
  EXPECT_TRUE(lines_of(scratch / "obstacles.csv")[2].starts_with("0.25,3,1,0,0,0,0,0,4,0,0,"));
}

TEST(EnergyLog, WhatCannotBeWrittenIsAnErrorOnEveryRank) {
  EXPECT_EQ(test::user_error_of([] { EnergyLog(world, "/dev/full"); }),
            "cannot write '/dev/full': No space left on device");
  const test::Scratch scratch;
  EXPECT_EQ(test::user_error_of([&] { EnergyLog(world, scratch / ""); }).substr(0, 12), "cannot write");
}

}  // namespace
}  // namespace evert
