#include "evert/io/export.hpp"

#include "evert/io/frame_writer.hpp"
#include "evert/mesh/mesh_reader.hpp"

#include <gtest/gtest.h>

#include "../mesh/test_meshes.hpp"
#include "scratch.hpp"
#include <cmath>
#include <cstring>

namespace evert {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

/// Two frames of a body that grows by half.
void write_run(const Mesh& whole, const std::string& path, const FrameFields& fields) {
  const auto mesh = distribute(world, whole);
  NodeField positions(mesh);
  NodeField velocities(mesh);
  FrameWriter writer(mesh, path, fields);
  for (const double time : {0.0, 0.5}) {
    for (std::size_t i = 0; i < positions.owned().size(); ++i)
      positions.owned()[i] = (1 + time) * mesh.rest_positions[i / 3][i % 3];
    for (auto& value : velocities.owned()) value = time;
    writer.write({time, 0, positions, velocities, [&](std::size_t block, std::span<double> per_cell) {
                    for (std::size_t i = 0; i < per_cell.size(); ++i)
                      per_cell[i] = static_cast<double>(mesh.cells[block].global_ids[i]) - 1;
                  }});
  }
}

/// The name of each cell's region; their numbers are the reader's own.
std::vector<std::string> regions_by_name(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const auto& block : mesh.cells)
    for (const auto region : block.region) names.push_back(mesh.regions[static_cast<std::size_t>(region)]);
  return names;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The numbers after a PLY header.
class PlyBody {
 public:
  explicit PlyBody(const std::string& file) : bytes_(file.substr(file.find("end_header\n") + 11)) {}
  template <class Number>
  Number next() {
    Number value{};
    EXPECT_LE(at_ + sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

TEST(Export, VtuHoldsTheDeformedMeshAndItsFields) {
  const test::Scratch scratch;
  const auto whole = test::mixed_row(4);
  write_run(whole, scratch / "run.h5", {});
  if (rank_of(world) != 0) return;
  const RunReader run(scratch / "run.h5");
  export_vtu(run, 1, scratch / "frame.vtu");
  const auto mesh = read_mesh(scratch / "frame.vtu");
  EXPECT_EQ(mesh.nodes, run.positions(1));
  EXPECT_EQ(regions_by_name(mesh), regions_by_name(whole));
  const auto text = test::content_of(scratch / "frame.vtu");
  for (const auto* array :
       {"\"min_stretch\"", "\"inverted\"", "\"rank\"", "\"velocity\" NumberOfComponents=\"3\""})
    EXPECT_TRUE(contains(text, array)) << array;
}

TEST(Export, VtuHasOnlyTheFieldsOfTheRun) {
  const test::Scratch scratch;
  write_run(test::tet_cube(2), scratch / "run.h5", {false, false, false, false});
  if (rank_of(world) != 0) return;
  export_vtu(RunReader(scratch / "run.h5"), 0, scratch / "frame.vtu");
  const auto text = test::content_of(scratch / "frame.vtu");
  for (const auto* array : {"min_stretch", "inverted", "rank", "velocity"})
    EXPECT_FALSE(contains(text, array)) << array;
}

TEST(Export, PlyHoldsAClosedSurfaceOfTheRightVolume) {
  const test::Scratch scratch;
  write_run(test::tet_cube(3), scratch / "run.h5", {});
  if (rank_of(world) != 0) return;
  export_surface_ply(RunReader(scratch / "run.h5"), 1, scratch / "frame.ply");
  const auto file = test::content_of(scratch / "frame.ply");
  EXPECT_TRUE(contains(file, "element vertex 56\n"));  // of 64 nodes, 8 lie inside
  EXPECT_TRUE(contains(file, "element face 108\n"));
  PlyBody body(file);
  std::vector<Vec3d> vertices(56);
  for (auto& vertex : vertices) {
    for (auto& component : vertex.components) component = body.next<double>();
    for (int c = 0; c < 3; ++c) EXPECT_EQ(body.next<double>(), 0.5);  // velocity
    EXPECT_GE(body.next<double>(), -1);                               // min_stretch
  }
  double volume = 0;  // by Gauss
  for (int face = 0; face < 108; ++face) {
    EXPECT_EQ(body.next<std::uint8_t>(), 3);
    std::array<Vec3d, 3> corner;
    for (auto& c : corner) c = vertices.at(body.next<std::uint32_t>());
    volume += dot(corner[0], cross(corner[1], corner[2])) / 6;
  }
  EXPECT_TRUE(body.at_end());
  EXPECT_NEAR(volume, 1.5 * 1.5 * 1.5, 1e-12);
}

TEST(Export, NamesTheFrameThatIsNotThere) {
  const test::Scratch scratch;
  write_run(test::tet_cube(2), scratch / "run.h5", {});
  if (rank_of(world) != 0) return;
  const RunReader run(scratch / "run.h5");
  EXPECT_EQ(test::user_error_of([&] { export_vtu(run, 2, scratch / "frame.vtu"); }),
            "'" + (scratch / "run.h5") + "' has no frame 2: it has 2");
  EXPECT_FALSE(std::filesystem::exists(scratch / "frame.vtu"));
}

}  // namespace
}  // namespace evert
