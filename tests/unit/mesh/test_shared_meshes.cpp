#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/quality.hpp"
#include "evert/mesh/repair.hpp"

#include "mesh_files.hpp"
#include <cstdlib>
#include <iostream>

namespace evert::test {
namespace {

struct Known {
  std::string name;
  GlobalIndex nodes;
  GlobalIndex tetrahedra;
};

/// Meshes from practice, which are no part of the project: in the folder that EVERT_SHARED_MESHES names.
class SharedMesh : public ::testing::TestWithParam<Known> {};

TEST_P(SharedMesh, is_read_whole) {
  const char* folder = std::getenv("EVERT_SHARED_MESHES");
  const auto path = std::filesystem::path(folder != nullptr ? folder : "") / GetParam().name;
  if (folder == nullptr || !std::filesystem::exists(path))
    GTEST_SKIP() << path << " is not there: set EVERT_SHARED_MESHES to the folder with " << GetParam().name;
  auto mesh = read_mesh(path);
  EXPECT_EQ(mesh.node_count(), GetParam().nodes);
  ASSERT_NE(mesh.block(CellType::tet4), nullptr);
  EXPECT_EQ(mesh.block(CellType::tet4)->size(), GetParam().tetrahedra);
  const auto quality = measure_quality(mesh);
  std::cout << GetParam().name << ": " << quality.nodes << " nodes, " << quality.cells << " cells, "
            << quality.components << " components, " << quality.negative_cells << " negative, "
            << quality.flat_cells << " flat, angles " << quality.dihedral_angle.smallest << " to "
            << quality.dihedral_angle.largest << '\n';
  EXPECT_EQ(quality.flat_cells, 0);
  reorient(mesh);
  EXPECT_NO_THROW(require_positive_volumes(mesh, path.string()));
}

INSTANTIATE_TEST_SUITE_P(All, SharedMesh,
                         ::testing::Values(Known{"Armadillo13K.msh", 13230, 54985},
                                           Known{"ball20k.msh", 3151, 19964}, Known{"ball404.msh", 89, 404},
                                           Known{"bunny.mesh", 5433, 34055}, Known{"cut_cube.msh", 187, 409},
                                           Known{"dolphin5K.msh", 8111, 36304}, Known{"liver.msh", 181, 596},
                                           Known{"mat40x40.msh", 3200, 9126},
                                           Known{"octopus-low.mesh", 452, 1140}, Known{"torus.msh", 200, 491},
                                           Known{"wedge_stack.msh", 11, 8}),
                         [](const auto& test) {
                           auto name = test.param.name;
                           std::ranges::replace_if(
                               name, [](char c) { return c == '.' || c == '-'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace evert::test
