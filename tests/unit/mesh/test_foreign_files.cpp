#include "evert/mesh/cell_geometry.hpp"
#include "evert/mesh/mesh_reader.hpp"

#include "mesh_files.hpp"
#include <cmath>
#include <map>

namespace evert::test {
namespace {

const std::filesystem::path data = EVERT_MESH_DATA;

std::map<std::string, std::size_t> sizes_of_node_sets(const Mesh& mesh) {
  std::map<std::string, std::size_t> sizes;
  for (const auto& set : mesh.node_sets) sizes[set.name] = set.nodes.size();
  return sizes;
}

class VtkWritten : public ::testing::TestWithParam<const char*> {};

TEST_P(VtkWritten, is_read_to_the_last_bit) {
  const auto expected = mixed_mesh();
  const auto mesh = read_mesh(data / GetParam());
  EXPECT_EQ(mesh.nodes, expected.nodes);
  expect_same_cells(mesh, expected);
  EXPECT_EQ(regions_of_cells(mesh), regions_of_cells(expected));
  ASSERT_EQ(mesh.node_sets.size(), expected.node_sets.size());
  for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
    EXPECT_EQ(mesh.node_sets[i].name, expected.node_sets[i].name);
    EXPECT_EQ(mesh.node_sets[i].nodes, expected.node_sets[i].nodes);
  }
}

INSTANTIATE_TEST_SUITE_P(ParaView, VtkWritten,
                         ::testing::Values("base64.vtu", "base64_zlib.vtu", "appended_raw.vtu",
                                           "appended_raw_zlib.vtu", "appended_base64_zlib.vtu",
                                           "binary_4.2.vtk", "binary_5.1.vtk"));

/// ParaView writes text with fewer digits, and Gmsh sorts its nodes.
class RoundedOrSorted : public ::testing::TestWithParam<const char*> {};

TEST_P(RoundedOrSorted, has_the_same_cells_and_groups) {
  const auto expected = mixed_mesh();
  const auto mesh = read_mesh(data / GetParam());
  auto regions = regions_of_cells(mesh);
  auto expected_regions = regions_of_cells(expected);
  std::ranges::sort(regions);
  std::ranges::sort(expected_regions);
  EXPECT_EQ(regions, expected_regions);
  EXPECT_EQ(sizes_of_node_sets(mesh), sizes_of_node_sets(expected));
  std::map<CellType, double> volumes;
  for_each_cell(mesh, [&](GlobalIndex, const CellBlock& block, std::size_t, std::span<const Vec3d> x) {
    EXPECT_GT(jacobian_range(block.type, x).smallest, 0.01);
    volumes[block.type] += cell_volume(block.type, x);
  });
  for_each_cell(expected, [&](GlobalIndex, const CellBlock& block, std::size_t, std::span<const Vec3d> x) {
    volumes[block.type] -= cell_volume(block.type, x);
  });
  for (const auto type : all_cell_types) EXPECT_NEAR(volumes.at(type), 0, 1e-5) << name_of(type);
}

INSTANTIATE_TEST_SUITE_P(ParaViewAndGmsh, RoundedOrSorted,
                         ::testing::Values("text.vtu", "text_5.1.vtk", "text_4.1.msh", "binary_4.1.msh",
                                           "binary_2.2.msh"));

/// Cut anywhere, no file may crash the reader, and what is left must not pass for a whole mesh.
TEST(CutFiles, are_refused) {
  const auto folder = std::filesystem::temp_directory_path() / ("evert_cut_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const auto& entry : std::filesystem::directory_iterator(data)) {
    if (entry.path().extension() == ".md") continue;
    const auto content = content_of(entry.path());
    const auto cut = folder / entry.path().filename();
    // Legacy VTK has no end mark: cut between two of its lists of data, the rest is a mesh with fewer of
    // them.
    const bool has_end = entry.path().extension() != ".vtk";
    const auto end = has_end ? content.find_last_not_of("\n") : content.find("METADATA");
    for (std::size_t size = 0; size < end; size += 1 + end / 151) {
      std::ofstream(cut, std::ios::binary) << content.substr(0, size);
      expect_user_error([&] { static_cast<void>(read_mesh(cut)); }, {cut.filename().string()});
    }
  }
  std::filesystem::remove_all(folder);
}

/// One byte changed at a time: every outcome is a mesh or a UserError, and no memory is taken that the file
/// cannot account for. A crash fails this test.
TEST(DamagedFiles, are_read_or_refused) {
  const auto folder = std::filesystem::temp_directory_path() / ("evert_damaged_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  int refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data)) {
    if (entry.path().extension() == ".md") continue;
    const auto content = content_of(entry.path());
    const auto damaged = folder / entry.path().filename();
    for (std::size_t at = 0; at < content.size(); at += 11) {
      auto changed = content;
      changed[at] = static_cast<char>(at % 3 == 0 ? 0xFF : at % 3 == 1 ? '9' : changed[at] ^ 0x40);
      std::ofstream(damaged, std::ios::binary) << changed;
      try {
        static_cast<void>(read_mesh(damaged));
      } catch (const UserError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 500);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace evert::test
