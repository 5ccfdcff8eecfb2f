#include "evert/io/checkpoint.hpp"

#include "evert/io/hdf5_file.hpp"

#include <gtest/gtest.h>

#include "../mesh/test_meshes.hpp"
#include "scratch.hpp"
#include <cmath>
#include <cstring>
#include <limits>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
const std::string scene = "scene: 'drop', of 3 lines\nand more";

/// Values that depend on the node only; `variant` tells states apart.
CheckpointState state_on(const DistributedMesh& mesh, int variant = 0) {
  CheckpointState state;
  for (const auto node : mesh.natural_nodes)
    for (int c = 0; c < 3; ++c) {
      const auto seed = static_cast<double>(3 * node + c + 1000 * variant);
      state.positions.push_back(std::sin(seed) / 3);
      state.velocities.push_back(1e-300 * std::cos(seed));
      state.velocity_changes.push_back(1e-3 * std::cos(2 * seed));
    }
  state.scalars = {{"time", 0.1 + variant},
                   {"steps", 12345},
                   {"tiny", 5e-324},
                   {"never", std::numeric_limits<double>::infinity()},
                   {"unset", std::numeric_limits<double>::quiet_NaN()}};
  return state;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

void expect_same(const CheckpointState& a, const CheckpointState& b) {
  EXPECT_TRUE(same_bits(a.positions, b.positions));
  EXPECT_TRUE(same_bits(a.velocities, b.velocities));
  EXPECT_TRUE(same_bits(a.velocity_changes, b.velocity_changes));
  ASSERT_EQ(a.scalars.size(), b.scalars.size());
  for (std::size_t i = 0; i < a.scalars.size(); ++i) {
    EXPECT_EQ(a.scalars[i].first, b.scalars[i].first);
    EXPECT_TRUE(same_bits({a.scalars[i].second}, {b.scalars[i].second})) << a.scalars[i].first;
  }
}

void write(const DistributedMesh& mesh, const std::string& path, int variant = 0) {
  const auto state = state_on(mesh, variant);
  CheckpointWriter(mesh, path, scene).write(state.nodes(), state.scalars);
}

std::string read_error(const DistributedMesh& mesh, const std::string& path,
                       const std::string& fingerprint = scene) {
  return test::user_error_of([&] { static_cast<void>(read_checkpoint(mesh, path, fingerprint)); });
}

TEST(Checkpoint, ComesBackBitByBit) {
  const test::Scratch scratch;
  for (const auto& whole : {test::tet_cube(3), test::mixed_row(6)}) {
    const auto mesh = distribute(world, whole);
    write(mesh, scratch / "checkpoint.h5");
    expect_same(read_checkpoint(mesh, scratch / "checkpoint.h5", scene), state_on(mesh));
    EXPECT_FALSE(std::filesystem::exists(scratch / "checkpoint.h5.tmp"));
  }
}

TEST(Checkpoint, ComesBackOnOtherRanks) {
  const test::Scratch scratch;
  const auto on_all = distribute(world, test::tet_cube(3));
  const auto on_one = distribute(MPI_COMM_SELF, test::tet_cube(3));
  write(on_all, scratch / "by_all.h5");
  expect_same(read_checkpoint(on_one, scratch / "by_all.h5", scene), state_on(on_one));
  if (rank_of(world) == 0) write(on_one, scratch / "by_one.h5");
  MPI_Barrier(world);
  expect_same(read_checkpoint(on_all, scratch / "by_one.h5", scene), state_on(on_all));

  // And on half of the ranks.
  MPI_Comm half = MPI_COMM_NULL;
  MPI_Comm_split(world, rank_of(world) < (size_of(world) + 1) / 2 ? 0 : 1, 0, &half);
  {
    const auto on_half = distribute(half, test::tet_cube(3));
    expect_same(read_checkpoint(on_half, scratch / "by_all.h5", scene), state_on(on_half));
  }
  MPI_Comm_free(&half);
}

TEST(Checkpoint, IsReplacedByTheNext) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(3));
  write(mesh, scratch / "checkpoint.h5", 1);
  write(mesh, scratch / "checkpoint.h5", 2);
  expect_same(read_checkpoint(mesh, scratch / "checkpoint.h5", scene), state_on(mesh, 2));
}

TEST(Checkpoint, SurvivesARunKilledWhileWritingTheNext) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(3));
  const auto path = scratch / "checkpoint.h5";
  write(mesh, path, 1);
  if (rank_of(world) == 0) {  // what a kill leaves: a piece of the next one
    const auto whole = test::content_of(path);
    std::ofstream(path + ".tmp", std::ios::binary) << whole.substr(0, whole.size() / 2);
  }
  MPI_Barrier(world);
  expect_same(read_checkpoint(mesh, path, scene), state_on(mesh, 1));
  MPI_Barrier(world);
  write(mesh, path, 2);
  expect_same(read_checkpoint(mesh, path, scene), state_on(mesh, 2));
}

TEST(Checkpoint, SurvivesAFullDisk) {
  const test::Scratch scratch;
  const test::SmallDisk disk(scratch / "disk", "300k");
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a tmpfs here";
  const auto mesh = distribute(world, test::tet_cube(12));  // 2197 nodes: 105 kB and an allowance
  const auto path = disk / "checkpoint.h5";
  write(mesh, path, 1);
  EXPECT_EQ(test::user_error_of([&] { write(mesh, path, 2); }),
            "cannot write '" + path + ".tmp': No space left on device");
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
  expect_same(read_checkpoint(mesh, path, scene), state_on(mesh, 1));
}

TEST(Checkpoint, TruncatedAnywhereIsAnErrorOnEveryRank) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(3));
  const auto path = scratch / "checkpoint.h5";
  write(mesh, path);
  const auto whole = test::content_of(path);
  for (std::size_t tenth = 0; tenth < 10; ++tenth) {
    MPI_Barrier(world);
    if (rank_of(world) == 0)
      std::ofstream(path, std::ios::binary) << whole.substr(0, whole.size() * tenth / 10);
    MPI_Barrier(world);
    const auto error = read_error(mesh, path);
    EXPECT_TRUE(error.starts_with("checkpoint '" + path + "' is truncated")) << tenth << ": " << error;
  }
}

TEST(Checkpoint, ChangedValuesAreFound) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(3));
  const auto path = scratch / "checkpoint.h5";
  write(mesh, path);
  const auto value = state_on(distribute(MPI_COMM_SELF, test::tet_cube(3))).positions.front();
  if (rank_of(world) == 0) {
    auto bytes = test::content_of(path);
    std::string needle(sizeof value, '\0');
    std::memcpy(needle.data(), &value, sizeof value);
    const auto at = bytes.find(needle);
    ASSERT_NE(at, std::string::npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    std::ofstream(path, std::ios::binary) << bytes;
  }
  MPI_Barrier(world);
  EXPECT_EQ(read_error(mesh, path),
            "checkpoint '" + path + "' is damaged: the values of '/positions' have changed");
}

TEST(Checkpoint, OtherFilesAreToldApart) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(3));
  const auto other_mesh = distribute(world, test::tet_cube(4));
  auto moved = test::tet_cube(3);
  moved.nodes.back()[0] += 1e-12;
  const auto moved_mesh = distribute(world, moved);
  const auto path = scratch / "checkpoint.h5";
  write(mesh, path);
  EXPECT_EQ(read_error(mesh, scratch / "none.h5"), "there is no checkpoint '" + (scratch / "none.h5") + "'");
  EXPECT_EQ(read_error(mesh, path, "other scene"), "checkpoint '" + path + "' belongs to another scene");
  EXPECT_EQ(read_error(other_mesh, path), "checkpoint '" + path + "' belongs to another mesh");
  EXPECT_EQ(read_error(moved_mesh, path), "checkpoint '" + path + "' belongs to another mesh");
  if (rank_of(world) == 0) {
    std::filesystem::create_directory(scratch / "directory");
    std::ofstream(scratch / "text") << "name: not a checkpoint";
    auto file = Hdf5File::create(MPI_COMM_SELF, scratch / "run.h5");
    file.set_attribute("/", "format", std::string("evert run"));
  }
  MPI_Barrier(world);
  EXPECT_EQ(read_error(mesh, scratch / "directory"),
            "checkpoint '" + (scratch / "directory") + "' is not a file");
  EXPECT_EQ(read_error(mesh, scratch / "text"), "'" + (scratch / "text") + "' is not a checkpoint of evert");
  EXPECT_EQ(read_error(mesh, scratch / "run.h5"),
            "'" + (scratch / "run.h5") + "' is not a checkpoint of evert");
}

TEST(Checkpoint, LongFingerprintsFit) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(2));
  const auto state = state_on(mesh);
  const std::string fingerprint(200000, 'x');
  CheckpointWriter(mesh, scratch / "c.h5", fingerprint).write(state.nodes(), state.scalars);
  expect_same(read_checkpoint(mesh, scratch / "c.h5", fingerprint), state);
}

TEST(Checkpoint, UnwritablePathsAreErrorsOnEveryRank) {
  const test::Scratch scratch;
  const auto mesh = distribute(world, test::tet_cube(2));
  if (rank_of(world) == 0) std::ofstream(scratch / "file") << "text";
  MPI_Barrier(world);
  EXPECT_EQ(test::user_error_of([&] { CheckpointWriter(mesh, scratch / "file/c.h5", scene); }),
            "cannot write '" + (scratch / "file/c.h5") + "': Not a directory");
}

}  // namespace
}  // namespace evert
