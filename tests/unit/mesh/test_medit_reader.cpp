#include "evert/mesh/mesh_reader.hpp"

#include "mesh_files.hpp"

namespace evert::test {
namespace {

using MeditReader = MeshFileTest;
using Names = std::vector<std::string>;
using Nodes = std::vector<GlobalIndex>;

constexpr std::string_view two_regions = R"(MeshVersionFormatted 1
# a comment
Dimension
3
Vertices
5
0 0 0 0
1 0 0 4
0 1 0 0
0 0 1 4 # another
1 1 1 0
Corners
2
1 2
Triangles
2
1 2 3 7
1 2 4 0
Tetrahedra
2
1 2 3 4 2
2 3 4 5 1
Edges
0
 End
)";

TEST_F(MeditReader, reads_references_as_groups) {
  const auto mesh = read_mesh(file("a.mesh", two_regions));
  EXPECT_EQ(mesh.node_count(), 5);
  EXPECT_EQ(mesh.block(CellType::tet4)->nodes, (Nodes{0, 1, 2, 3, 1, 2, 3, 4}));
  EXPECT_EQ(regions_of_cells(mesh), (Names{"ref_2", "ref_1"}));
  ASSERT_EQ(mesh.node_sets.size(), 2U);
  EXPECT_EQ(mesh.node_sets[0].name, "vertices_4");
  EXPECT_EQ(mesh.node_sets[0].nodes, (Nodes{1, 3}));
  EXPECT_EQ(mesh.node_sets[1].name, "surface_7");
  EXPECT_EQ(mesh.node_sets[1].nodes, (Nodes{0, 1, 2}));
}

TEST_F(MeditReader, accepts_headers_without_spaces_and_other_line_ends) {
  std::string content(two_regions);
  content.replace(content.find("MeshVersionFormatted 1"), 22, "MeshVersionFormatted2");
  content.replace(content.find("Dimension\n3"), 11, "Dimension3");
  std::string windows;
  for (const char c : content) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_mesh(file("a.mesh", content)).cell_count(), 2);
  EXPECT_EQ(read_mesh(file("b.mesh", windows)).cell_count(), 2);
}

std::string with(std::string_view from, std::string_view to) {
  std::string result(two_regions);
  const auto at = result.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return result.replace(at, from.size(), to);
}

TEST_F(MeditReader, names_the_line_of_what_is_wrong) {
  struct Case {
    std::string content;
    std::string_view place;
    std::string_view fault;
  };
  const std::vector<Case> cases{
      {with("Formatted 1", "Formatted 9"), "a.mesh:1:", "version 9 is not read; allowed are 1 to 4"},
      {with("Dimension\n3", "Dimension\n2"), "a.mesh:4:", "the dimension must be 3"},
      {with("Dimension\n3", "Vertices\n3"), "a.mesh:3:", "Dimension is expected"},
      {with("1 0 0 4", "1 nan 0 4"), "a.mesh:8:", "finite"},
      {with("1 0 0 4", "1 0 0 x"), "a.mesh:8:", "the reference of a vertex must be a whole number, not 'x'"},
      {with("2 3 4 5 1", "2 3 4 6 1"), "a.mesh:22:", "no vertex 6; allowed are 1 to 5"},
      {with("2 3 4 5 1", "2 3 4 0 1"), "a.mesh:22:", "no vertex 0"},
      {with("Vertices\n5", "Vertices\n50000000"), "a.mesh:6:", "more than the remaining"},
      {with("Vertices\n5", "Vertices\n-1"), "a.mesh:6:", "must not be negative"},
      {with("Tetrahedra\n2", "Tetrahedra\n3"), "a.mesh:23:", "not 'Edges'"},
      {with("Tetrahedra", "Tetraeder"), "a.mesh:19:", "did you mean 'Tetrahedra'?"},
      {with("Tetrahedra\n2", "Pyramids\n2"), "a.mesh:20:", "Pyramids cannot be simulated"},
      {with(" End\n", ""), "a.mesh:24:", "a keyword or 'End' is expected (truncated?)"},
      {with("Tetrahedra\n2\n1 2 3 4 2\n2 3 4 5 1\n", ""), "a.mesh", "no volume cells"},
  };
  for (const auto& [content, place, fault] : cases) {
    const auto broken = file("a.mesh", content);
    expect_user_error([&] { static_cast<void>(read_mesh(broken)); }, {place, fault});
  }
}

TEST_F(MeditReader, refuses_files_cut_anywhere) {
  for (std::size_t size = 0; size + 2 < two_regions.size(); ++size) {
    const auto cut = file("cut.mesh", two_regions.substr(0, size));
    expect_user_error([&] { static_cast<void>(read_mesh(cut)); }, {"cut.mesh"});
  }
}

}  // namespace
}  // namespace evert::test
