#include "evert/io/frame_writer.hpp"

#include "evert/io/run_reader.hpp"

#include <gtest/gtest.h>

#include "../mesh/test_meshes.hpp"
#include "scratch.hpp"
#include <cmath>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

// What the frames show depends on position, time and cell number only, so that files of any rank count are
// alike.
double stretch_of(GlobalIndex cell, double time) { return std::cos(static_cast<double>(cell)) - time; }

/// A body in made-up motion.
class Motion {
 public:
  explicit Motion(const Mesh& mesh) : mesh_(distribute(world, mesh)), positions_(mesh_), velocities_(mesh_) {}

  [[nodiscard]] const DistributedMesh& mesh() const { return mesh_; }
  FrameSource at(double time) {
    for (std::size_t i = 0; i < positions_.owned().size(); ++i) {
      const double rest = mesh_.rest_positions[i / 3][i % 3];
      positions_.owned()[i] = rest * (1 + time);
      velocities_.owned()[i] = rest;
    }
    return {time, static_cast<std::int64_t>(std::lround(100 * time)), positions_, velocities_,
            [this, time](std::size_t block, std::span<double> per_cell) {
              for (std::size_t i = 0; i < per_cell.size(); ++i)
                per_cell[i] = stretch_of(mesh_.cells[block].global_ids[i], time);
            }};
  }

 private:
  DistributedMesh mesh_;
  NodeField positions_;
  NodeField velocities_;
};

void expect_same_mesh(const Mesh& read, const Mesh& expected) {
  EXPECT_EQ(read.nodes, expected.nodes);
  EXPECT_EQ(read.regions, expected.regions);
  ASSERT_EQ(read.cells.size(), expected.cells.size());
  for (std::size_t b = 0; b < read.cells.size(); ++b) {
    EXPECT_EQ(read.cells[b].type, expected.cells[b].type);
    EXPECT_EQ(read.cells[b].nodes, expected.cells[b].nodes);
    EXPECT_EQ(read.cells[b].region, expected.cells[b].region);
  }
}

/// The mesh without its unused nodes, as files have it.
Mesh compacted(Mesh mesh) {
  std::vector<GlobalIndex> number(mesh.nodes.size(), -1);
  for (const auto& block : mesh.cells)
    for (const auto node : block.nodes) number[static_cast<std::size_t>(node)] = 0;
  std::vector<Vec3d> nodes;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] == 0) {
      number[i] = static_cast<GlobalIndex>(nodes.size());
      nodes.push_back(mesh.nodes[i]);
    }
  for (auto& block : mesh.cells)
    for (auto& node : block.nodes) node = number[static_cast<std::size_t>(node)];
  mesh.nodes = nodes;
  return mesh;
}

void expect_frames(const RunReader& run, std::size_t count, double interval) {
  const auto mesh = run.mesh();
  ASSERT_EQ(run.frames().size(), count);
  for (std::size_t frame = 0; frame < count; ++frame) {
    const double time = interval * static_cast<double>(frame);
    EXPECT_EQ(run.frames()[frame].time, time);
    EXPECT_EQ(run.frames()[frame].step, std::lround(100 * time));
    const auto positions = run.positions(frame);
    for (std::size_t i = 0; i < positions.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(positions[i][c], mesh.nodes[i][c] * (1 + time));
    EXPECT_EQ(run.velocities(frame), mesh.nodes);
    const auto stretch = run.min_stretch(frame);
    const auto inverted = run.inverted(frame);
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      EXPECT_EQ(stretch[i], stretch_of(static_cast<GlobalIndex>(i), time));
      EXPECT_EQ(inverted[i], stretch[i] < 0 ? 1 : 0);
    }
  }
}

TEST(FrameWriter, WritesWhatTheReaderReads) {
  for (const auto& mesh : {test::tet_cube(3), test::mixed_row(5)}) {
    const test::Scratch scratch;
    Motion motion(mesh);
    {
      FrameWriter writer(motion.mesh(), scratch / "run.h5", {});
      for (int frame = 0; frame < 3; ++frame) writer.write(motion.at(0.25 * frame));
    }
    if (rank_of(world) != 0) continue;
    const RunReader run(scratch / "run.h5");
    expect_same_mesh(run.mesh(), compacted(mesh));
    expect_frames(run, 3, 0.25);
    const auto ranks = run.ranks();
    for (int rank = 0; rank < size_of(world); ++rank)
      EXPECT_GT(std::count(ranks.begin(), ranks.end(), rank), 0);
  }
}

TEST(FrameWriter, WritesOnlyTheFieldsAskedFor) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  FrameWriter writer(motion.mesh(), scratch / "run.h5", {false, false, true, false});
  auto source = motion.at(0.5);
  writer.write(source);
  if (rank_of(world) != 0) return;
  const RunReader run(scratch / "run.h5");
  EXPECT_FALSE(run.has(0, "velocity"));
  EXPECT_FALSE(run.has(0, "min_stretch"));
  EXPECT_TRUE(run.has(0, "inverted"));
  EXPECT_EQ(test::user_error_of([&] { static_cast<void>(run.velocities(0)); }),
            "frame 0 of '" + (scratch / "run.h5") + "' has no field 'velocity'");
  EXPECT_THROW(static_cast<void>(run.ranks()), UserError);
  const auto xdmf = test::content_of(scratch / "run.xdmf");
  EXPECT_EQ(xdmf.find("velocity"), std::string::npos);
  EXPECT_NE(xdmf.find("inverted"), std::string::npos);
}

TEST(FrameWriter, AsksForNoStretchesThatItDoesNotWrite) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  FrameWriter writer(motion.mesh(), scratch / "run.h5", {true, false, false, true});
  auto source = motion.at(0);
  source.min_stretch = [](std::size_t, std::span<double>) { FAIL(); };
  writer.write(source);
}

TEST(FrameWriter, FilesAreReadableWhileTheRunGoesOn) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  FrameWriter writer(motion.mesh(), scratch / "run.h5", {});
  for (int frame = 0; frame < 3; ++frame) {
    writer.write(motion.at(0.5 * frame));
    if (rank_of(world) == 0) {
      expect_frames(RunReader(scratch / "run.h5"), static_cast<std::size_t>(frame) + 1, 0.5);
      const auto xdmf = test::content_of(scratch / "run.xdmf");
      EXPECT_NE(xdmf.find("</Xdmf>"), std::string::npos);
      EXPECT_NE(xdmf.find(writer.frames().back().group), std::string::npos);
    }
    MPI_Barrier(world);
  }
}

TEST(FrameWriter, ContinuesARunWithoutItsLaterFrames) {
  const test::Scratch scratch;
  Motion motion(test::mixed_row(5));
  {
    FrameWriter writer(motion.mesh(), scratch / "run.h5", {});
    for (int frame = 0; frame < 5; ++frame) writer.write(motion.at(0.25 * frame));
  }
  {
    auto writer = FrameWriter::continue_from(motion.mesh(), scratch / "run.h5", {}, 0.5);
    EXPECT_EQ(writer.frames().size(), 3U);
    writer.write(motion.at(0.75));
  }
  if (rank_of(world) == 0) expect_frames(RunReader(scratch / "run.h5"), 4, 0.25);
}

std::vector<std::unique_ptr<Obstacle>> moving_and_standing() {
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  obstacles.push_back(std::make_unique<Obstacle>(
      "ball", 0.1, std::make_unique<Sphere>(0.5),
      std::make_unique<UniformMotion>(RigidState{.origin = {0, 2, 0}, .velocity = {1, 0, 0}})));
  obstacles.push_back(std::make_unique<Obstacle>("ground", 0.1,
                                                 std::make_unique<HalfSpace>(Vec3d{}, Vec3d{0, 1, 0}),
                                                 std::make_unique<UniformMotion>(RigidState{})));
  return obstacles;
}

TEST(FrameWriter, WritesWhereObstaclesAreWhenTheyHaveMoved) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  const auto obstacles = moving_and_standing();
  const auto write = [&](FrameWriter writer, double begin) {
    for (double time = begin; time < begin + 0.7; time += 0.25) {
      for (const auto& obstacle : obstacles) obstacle->move_to({.end = time, .dt = 0.25});
      writer.write(motion.at(time));
    }
  };
  write(FrameWriter(motion.mesh(), scratch / "run.h5", {}, obstacles), 0);
  write(FrameWriter::continue_from(motion.mesh(), scratch / "run.h5", {}, 0.5, obstacles), 0.75);
  if (rank_of(world) != 0) return;
  const RunReader run(scratch / "run.h5");
  ASSERT_EQ(run.frames().size(), 6U);
  const auto shown = run.obstacles();
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[0].name, "ball");
  EXPECT_GT(shown[0].triangles.size(), 100U);
  for (std::size_t frame = 0; frame < 6; ++frame) {
    for (const auto& point : run.obstacle_points(frame, shown[0]))
      EXPECT_NEAR(norm(point - Vec3d{0.25 * static_cast<double>(frame), 2, 0}), 0.5, 0.01);
    for (const auto& point : run.obstacle_points(frame, shown[1])) EXPECT_EQ(point[1], 0);
  }
  const auto xdmf = test::content_of(scratch / "run.xdmf");
  EXPECT_NE(xdmf.find(">run.h5:/frames/00000001/obstacles/ball<"), std::string::npos);
  EXPECT_EQ(xdmf.find(">run.h5:/frames/00000001/obstacles/ground<"), std::string::npos) << "it stands still";
}

TEST(FrameWriter, ContinuesWhereThereIsNoRunByBeginning) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  auto writer = FrameWriter::continue_from(motion.mesh(), scratch / "new/run.h5", {}, 0.5);
  writer.write(motion.at(0));
  if (rank_of(world) == 0) expect_frames(RunReader(scratch / "new/run.h5"), 1, 0.25);
}

TEST(FrameWriter, ContinuesOnlyARunOfTheSameMesh) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  Motion other(test::tet_cube(3));
  { FrameWriter writer(motion.mesh(), scratch / "run.h5", {}); }
  EXPECT_EQ(test::user_error_of([&] {
              static_cast<void>(FrameWriter::continue_from(other.mesh(), scratch / "run.h5", {}, 0));
            }),
            "cannot continue '" + (scratch / "run.h5") +
                "': it has 27 nodes and 48 cells, the mesh has 64 and 162");
}

TEST(FrameWriter, MakesTheDirectoryOfItsFile) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  const FrameWriter writer(motion.mesh(), scratch / "a/b/run.h5", {});
  EXPECT_EQ(writer.xdmf_path(), scratch / "a/b/run.xdmf");
}

TEST(FrameWriter, UnwritablePathsAreErrorsOnEveryRank) {
  const test::Scratch scratch;
  Motion motion(test::tet_cube(2));
  if (rank_of(world) == 0) {
    std::filesystem::create_directory(scratch / "run.h5");
    std::ofstream(scratch / "file") << "text";
  }
  MPI_Barrier(world);
  EXPECT_EQ(test::user_error_of([&] { FrameWriter(motion.mesh(), scratch / "run.h5", {}); }),
            "cannot write '" + (scratch / "run.h5") + "': Is a directory");
  EXPECT_EQ(test::user_error_of([&] { FrameWriter(motion.mesh(), scratch / "file/run.h5", {}); }),
            "cannot write '" + (scratch / "file/run.h5") + "': Not a directory");
  EXPECT_NE(test::user_error_of([&] { FrameWriter(motion.mesh(), "/proc/run.h5", {}); }), "");
}

TEST(FrameWriter, AFullDiskIsAnErrorOnEveryRankAndEarlierFramesStayReadable) {
  const test::Scratch scratch;
  const test::SmallDisk disk(scratch / "disk", "600k");
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a tmpfs here";
  Motion motion(test::tet_cube(8));  // 729 nodes, 3072 cells: 63 kB a frame
  std::size_t written = 0;
  std::string message;
  {
    FrameWriter writer(motion.mesh(), disk / "run.h5", {});
    while (message.empty() && written < 100) {
      message = test::user_error_of([&] { writer.write(motion.at(0.25 * static_cast<double>(written))); });
      if (message.empty()) ++written;
    }
  }
  // Which file the disk is too small for is a matter of a few bytes; the frame stands when it is the second.
  const bool frame_stands = message.find("run.xdmf") != std::string::npos;
  const std::string file = frame_stands ? "run.xdmf.tmp" : "run.h5";
  EXPECT_EQ(message, "cannot write '" + (disk / file) + "': No space left on device");
  EXPECT_GE(written, 2U);
  EXPECT_LT(written, 10U);
  if (rank_of(world) == 0) {
    expect_frames(RunReader(disk / "run.h5"), written + (frame_stands ? 1 : 0), 0.25);
    EXPECT_NE(test::content_of(disk / "run.xdmf").find("</Xdmf>"), std::string::npos);
  }
}

TEST(FrameWriter, AFullDiskAtTheStartIsAnErrorOnEveryRank) {
  const test::Scratch scratch;
  const test::SmallDisk disk(scratch / "disk", "64k");
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a tmpfs here";
  Motion motion(test::tet_cube(8));
  EXPECT_EQ(test::user_error_of([&] { FrameWriter(motion.mesh(), disk / "run.h5", {}); }),
            "cannot write '" + (disk / "run.h5") + "': No space left on device");
}

}  // namespace
}  // namespace evert
