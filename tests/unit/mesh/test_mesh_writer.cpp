#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/mesh_writer.hpp"

#include "mesh_files.hpp"
#include <csignal>
#include <sys/resource.h>

namespace evert::test {
namespace {

using MeshWriter = MeshFileTest;

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

TEST_F(MeshWriter, writes_what_is_read_back_to_the_last_bit) {
  const auto mesh = mixed_mesh();
  const std::vector<std::pair<std::string, MeshFormat>> formats{{"a.msh", MeshFormat::gmsh41},
                                                                {"b.msh", MeshFormat::gmsh22},
                                                                {"a.vtk", MeshFormat::vtk},
                                                                {"a.vtu", MeshFormat::vtu}};
  for (const auto& [name, format] : formats) {
    write_mesh(mesh, path(name), format);
    const auto back = read_mesh(path(name));
    EXPECT_EQ(back.nodes, mesh.nodes) << name;
    expect_same_cells(back, mesh);
    EXPECT_EQ(regions_of_cells(back), regions_of_cells(mesh)) << name;
    ASSERT_EQ(back.node_sets.size(), mesh.node_sets.size()) << name;
    for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
      EXPECT_EQ(back.node_sets[i].name, mesh.node_sets[i].name) << name;
      EXPECT_EQ(back.node_sets[i].nodes, mesh.node_sets[i].nodes) << name;
    }
    EXPECT_EQ(what_is_lost(mesh, format), "") << name;
  }
  EXPECT_EQ(files_in(path(".")), (std::vector<std::string>{"a.msh", "a.vtk", "a.vtu", "b.msh"}));
}

TEST_F(MeshWriter, tells_what_medit_cannot_hold) {
  auto mesh = mixed_mesh();
  EXPECT_NE(what_is_lost(mesh, MeshFormat::medit).find("node sets"), std::string::npos);
  write_mesh(mesh, path("a.mesh"));
  auto back = read_mesh(path("a.mesh"));
  EXPECT_EQ(back.nodes, mesh.nodes);
  expect_same_cells(back, mesh);
  EXPECT_EQ(regions_of_cells(back), (std::vector<std::string>{"ref_2", "ref_1", "ref_1", "ref_2", "ref_1"}));

  // Its own references survive.
  mesh.node_sets.clear();
  mesh.regions = {"ref_12", "ref_-3"};
  EXPECT_EQ(what_is_lost(mesh, MeshFormat::medit), "");
  write_mesh(mesh, path("a.mesh"));
  back = read_mesh(path("a.mesh"));
  EXPECT_EQ(regions_of_cells(back), regions_of_cells(mesh));
}

TEST_F(MeshWriter, survives_strange_names) {
  auto mesh = mixed_mesh();
  mesh.regions = {"a \"b\" <c> & 100% \xC3\xA9", "  "};
  mesh.node_sets[0].name = "x/y\\z % & \"";
  for (const auto* name : {"a.vtk", "a.vtu"}) {
    write_mesh(mesh, path(name));
    const auto back = read_mesh(path(name));
    EXPECT_EQ(regions_of_cells(back), regions_of_cells(mesh)) << name;
    EXPECT_EQ(back.node_sets[0].name, mesh.node_sets[0].name) << name;
  }
  mesh.regions[0] = "two\nlines";  // Gmsh's names end with the line
  write_mesh(mesh, path("a.msh"));
  EXPECT_EQ(regions_of_cells(read_mesh(path("a.msh")))[1], "two_lines");
}

TEST_F(MeshWriter, writes_cell_fields_where_the_format_has_them) {
  const auto mesh = mixed_mesh();
  const std::vector fields{CellField{"rank", std::vector<std::int32_t>{3, 1, 4, 1, 5}}};
  write_mesh(mesh, path("a.vtk"), fields);
  EXPECT_NE(content_of(path("a.vtk")).find("SCALARS rank int 1\nLOOKUP_TABLE default\n3\n1\n4\n1\n5\n"),
            std::string::npos);
  write_mesh(mesh, path("a.vtu"), fields);
  EXPECT_NE(content_of(path("a.vtu")).find("Name=\"rank\""), std::string::npos);
  expect_user_error([&] { write_mesh(mesh, path("a.msh"), fields); }, {"a.msh", ".vtk and .vtu files only"});
}

TEST_F(MeshWriter, refuses_what_it_cannot_write) {
  const auto mesh = mixed_mesh();
  expect_user_error([&] { write_mesh(mesh, path("a.stl")); }, {"a.stl", "extension", "not '.stl'"});
  expect_user_error([&] { write_mesh(mesh, path("no/such/folder.msh")); },
                    {"folder.msh: cannot be written: No such"});
  std::filesystem::create_directories(path("folder.msh"));
  expect_user_error([&] { write_mesh(mesh, path("folder.msh")); }, {"folder.msh", "not a regular file"});
}

/// A limit on the size of files stands for a full disk: the write fails, the old file stays, no rest is left.
TEST_F(MeshWriter, leaves_the_old_file_when_the_disk_is_full) {
  const auto mesh = mixed_mesh();
  file("a.msh", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{512, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  expect_user_error([&] { write_mesh(mesh, path("a.msh")); }, {"a.msh: cannot be written: File too large"});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(content_of(path("a.msh")), "old");
  EXPECT_EQ(files_in(path(".")), std::vector<std::string>{"a.msh"});
}

}  // namespace
}  // namespace evert::test
