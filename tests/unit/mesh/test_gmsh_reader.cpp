#include "evert/mesh/mesh_reader.hpp"

#include "mesh_files.hpp"

namespace evert::test {
namespace {

using GmshReader = MeshFileTest;
using Names = std::vector<std::string>;
using Nodes = std::vector<GlobalIndex>;

constexpr std::string_view two_regions22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
3 1 "steel"
3 2 "soft rubber"
2 7 "wall"
$EndPhysicalNames
$Comments
anything $EndNodes here
$EndComments
$Nodes
5
10 0 0 0
30 1 0 0
20 0 1 0
99 0 0 1
7 1 1 1e0
$EndNodes
$Elements
5
1 15 2 3 1 99
2 2 2 7 1 10 30 20
3 4 2 2 1 10 30 20 99
4 4 4 1 2 1 1 30 20 99 7
5 4 0 10 30 20 7
$EndElements
)";

TEST_F(GmshReader, reads_groups_and_sparse_tags_of_2_2) {
  const auto mesh = read_mesh(file("a.msh", two_regions22));
  EXPECT_EQ(mesh.nodes[1], (Vec3d{1, 0, 0}));
  ASSERT_NE(mesh.block(CellType::tet4), nullptr);
  EXPECT_EQ(mesh.block(CellType::tet4)->nodes, (Nodes{0, 1, 2, 3, 1, 2, 3, 4, 0, 1, 2, 4}));
  EXPECT_EQ(regions_of_cells(mesh), (Names{"soft rubber", "steel", "default"}));
  ASSERT_EQ(mesh.node_sets.size(), 2U);
  EXPECT_EQ(mesh.node_sets[0].name, "point_3");
  EXPECT_EQ(mesh.node_sets[0].nodes, (Nodes{3}));
  EXPECT_EQ(mesh.node_sets[1].name, "wall");
  EXPECT_EQ(mesh.node_sets[1].nodes, (Nodes{0, 1, 2}));
}

constexpr std::string_view entities41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
2 5 "clamped"
3 1 "steel"
3 2 "all"
$EndPhysicalNames
$Entities
1 0 1 2
4 0 0 1 1 9
3 0 0 0 1 1 1 2 5 -6 1 4
1 0 0 0 1 1 1 2 1 2 1 3
2 0 0 0 1 1 1 0 0
$EndEntities
$Nodes
2 5 1 50
2 3 1 3
1
2
30
0 0 0 0.5 0.5
1 0 0 0.5 0.5
0 1 0 0.5 0.5
3 1 0 2
40
50
0 0 1
1 1 1
$EndNodes
$Elements
4 4 1 4
0 4 15 1
1 50
2 3 2 1
2 1 2 30
3 1 4 1
3 1 2 30 40
3 2 4 1
4 2 30 40 50
$EndElements
)";

TEST_F(GmshReader, reads_entities_of_4_1) {
  const auto mesh = read_mesh(file("a.msh", entities41));
  EXPECT_EQ(mesh.node_count(), 5);
  EXPECT_EQ(mesh.nodes[4], (Vec3d{1, 1, 1}));
  EXPECT_EQ(mesh.block(CellType::tet4)->nodes, (Nodes{0, 1, 2, 3, 1, 2, 3, 4}));
  EXPECT_EQ(regions_of_cells(mesh), (Names{"steel", "default"}));
  // A point in an unnamed group, a surface in two groups (one reversed), the second group of a volume.
  Names names;
  for (const auto& set : mesh.node_sets) names.push_back(set.name);
  EXPECT_EQ(names, (Names{"point_9", "clamped", "surface_6", "all"}));
  EXPECT_EQ(mesh.node_sets[2].nodes, (Nodes{0, 1, 2}));
  EXPECT_EQ(mesh.node_sets[3].nodes, (Nodes{0, 1, 2, 3}));
}

/// The tetrahedron 1 2 3 4 in the physical volume 1, "body", in Gmsh's binary formats.
std::string binary22(std::endian order) {
  Bytes bytes(order);
  bytes.text("$MeshFormat\n2.2 1 8\n").put(1).text("\n$EndMeshFormat\n");
  bytes.text("$PhysicalNames\n1\n3 1 \"body\"\n$EndPhysicalNames\n$Nodes\n4\n");
  const double positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 4; ++i) bytes.put(i + 1).put(positions[i][0]).put(positions[i][1]).put(positions[i][2]);
  bytes.text("\n$EndNodes\n$Elements\n2\n");
  bytes.put_all({2, 1, 2, 1, 3, 1, 1, 2, 3});     // a block of one triangle with two tags
  bytes.put_all({4, 1, 2, 2, 1, 1, 1, 2, 3, 4});  // a block of one tetrahedron
  return bytes.text("\n$EndElements\n").str();
}

std::string binary41(std::endian order) {
  Bytes bytes(order);
  using Size = std::uint64_t;
  bytes.text("$MeshFormat\n4.1 1 8\n").put(1).text("\n$EndMeshFormat\n");
  bytes.text("$PhysicalNames\n2\n2 3 \"side\"\n3 1 \"body\"\n$EndPhysicalNames\n$Entities\n");
  bytes.put_all<Size>({0, 0, 1, 1});
  bytes.put(1).put_all<double>({0, 0, 0, 1, 1, 0}).put<Size>(1).put(3).put<Size>(0);
  bytes.put(1).put_all<double>({0, 0, 0, 1, 1, 1}).put<Size>(1).put(1).put<Size>(1).put(1);
  bytes.text("\n$EndEntities\n$Nodes\n").put_all<Size>({1, 4, 1, 4});
  bytes.put_all({3, 1, 0}).put_all<Size>({4, 1, 2, 3, 4});
  bytes.put_all<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  bytes.text("\n$EndNodes\n$Elements\n").put_all<Size>({2, 2, 1, 2});
  bytes.put_all({2, 1, 2}).put_all<Size>({1, 1, 1, 2, 3});
  bytes.put_all({3, 1, 4}).put_all<Size>({1, 2, 1, 2, 3, 4});
  return bytes.text("\n$EndElements\n").str();
}

TEST_F(GmshReader, reads_binary_in_both_byte_orders) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    for (const auto& [content, set] :
         {std::pair{binary22(order), "surface_3"}, std::pair{binary41(order), "side"}}) {
      const auto mesh = read_mesh(file("a.msh", content));
      EXPECT_EQ(mesh.nodes[3], (Vec3d{0, 0, 1}));
      EXPECT_EQ(mesh.block(CellType::tet4)->nodes, (Nodes{0, 1, 2, 3}));
      EXPECT_EQ(mesh.regions, (Names{"body"}));
      ASSERT_EQ(mesh.node_sets.size(), 1U);
      EXPECT_EQ(mesh.node_sets[0].name, set);
      EXPECT_EQ(mesh.node_sets[0].nodes, (Nodes{0, 1, 2}));
    }
  }
}

TEST_F(GmshReader, refuses_binary_cut_at_every_byte) {
  for (const auto& content : {binary22(std::endian::little), binary41(std::endian::little)})
    for (std::size_t size = 1; size + 1 < content.size(); ++size) {
      const auto cut = file("cut.msh", content.substr(0, size));
      if (content.substr(size) != "\n")
        expect_user_error([&] { static_cast<void>(read_mesh(cut)); }, {"cut.msh"});
    }
}

/// The text with the first occurrence of `from` replaced.
std::string with(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  const auto at = result.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return result.replace(at, from.size(), to);
}

TEST_F(GmshReader, names_the_line_of_what_is_wrong) {
  struct Case {
    std::string content;
    std::string_view place;
    std::string_view fault;
  };
  const std::vector<Case> cases{
      {with(two_regions22, "2.2 0", "3.0 0"), "a.msh:2:", "version 3 is not read; allowed are 2.2 and 4.1"},
      {with(two_regions22, "2.2 0 8", "4 0 8"), "a.msh:2:", "allowed are 2.2 and 4.1"},
      {with(two_regions22, "2.2 0 8", "2.2 7 8"), "a.msh:2:", "0 (ASCII) or 1 (binary)"},
      {with(two_regions22, "$MeshFormat", "$NOD"), "a.msh:1:", "format 1"},
      {with(two_regions22, "30 1 0 0", "30 nan 0 0"), "a.msh:16:", "finite number, not 'nan'"},
      {with(two_regions22, "30 1 0 0", "30 -inf 0 0"), "a.msh:16:", "finite number"},
      {with(two_regions22, "30 1 0 0", "30 1e999 0 0"), "a.msh:16:", "finite number"},
      {with(two_regions22, "30 1 0 0", "30 one 0 0"), "a.msh:16:", "must be a number, not 'one'"},
      {with(two_regions22, "30 1 0 0", "10 1 0 0"), "a.msh:16:", "node tag 10 is given a second time"},
      {with(two_regions22, "10 30 20 99\n4", "10 30 21 99\n4"),
       "a.msh:25:", "no node 21; the nodes go from 7 to 99"},
      {with(two_regions22, "3 4 2 2 1", "3 7 2 2 1"), "a.msh:25:", "pyramid5"},
      {with(two_regions22, "3 4 2 2 1", "3 92 2 2 1"), "a.msh:25:", "element type 92 is not known"},
      {with(two_regions22, "$Nodes\n5", "$Nodes\n6"), "a.msh:20:", "must be a whole number, not '$EndNodes'"},
      {with(two_regions22, "$Nodes\n5", "$Nodes\n4"), "a.msh:19:", "$EndNodes is expected here"},
      {with(two_regions22, "$Nodes\n5", "$Nodes\n-5"), "a.msh:14:", "must not be negative"},
      {with(two_regions22, "$Nodes\n5", "$Nodes\n900000000000"), "a.msh:14:", "more than the remaining"},
      {with(two_regions22, "$Elements\n5", "$Elements\n8000000000000000000"),
       "a.msh:22:", "more than the remaining"},
      {with(two_regions22, "4 4 4 1", "4 4 9000000 1"),
       "a.msh:26:", "number of tags of an element is 9000000"},
      {with(two_regions22, "3 1 \"steel\"", "4 1 \"steel\""), "a.msh:6:", "must be 0, 1, 2 or 3"},
      {with(two_regions22, "\"steel\"", "steel"), "a.msh:6:", "double quotes"},
      {with(two_regions22, "$EndComments", "$EndComment"), "a.msh:10:", "has no $EndComments"},
      {with(two_regions22, "$Comments", "Comments"), "a.msh:10:", "a section such as $Nodes"},
      {with(entities41, "2 5 1 50", "2 6 1 50"), "a.msh:30:", "hold 5 nodes, but the section promises 6"},
      {with(entities41, "4 4 1 4", "4 5 1 4"), "a.msh:41:", "hold 4 elements, but the section promises 5"},
      {with(entities41, "3 1 4 1\n", "2 1 4 1\n"), "a.msh:38:", "tet4 cannot be on an entity of dimension 2"},
      {with(entities41, "3 1 4 1\n", "5 1 4 1\n"), "a.msh:38:", "must be 0, 1, 2 or 3"},
      {with(entities41, "3 1 0 2", "3 1 0 2000000"), "a.msh:26:", "more than the remaining"},
      {with(entities41, "$Entities", "$PartitionedEntities"), "a.msh:10:", "partitioned"},
      {with(entities41, "$Elements", "$Nodes"), "a.msh:32:", "second section $Nodes"},
  };
  for (const auto& [content, place, fault] : cases) {
    const auto broken = file("a.msh", content);
    expect_user_error([&] { static_cast<void>(read_mesh(broken)); }, {place, fault});
  }
}

TEST_F(GmshReader, names_the_byte_in_binary_files) {
  auto content = binary41(std::endian::little);
  const auto at = content.find("$Elements\n") + 10 + 4 * 8 + 2 * 4;  // the type of the first block
  content[at] = 77;
  const auto broken = file("a.msh", content);
  expect_user_error([&] { static_cast<void>(read_mesh(broken)); },
                    {"a.msh: byte " + std::to_string(at) + ":", "element type 77 is not known"});
}

TEST_F(GmshReader, needs_nodes_elements_and_volume_cells) {
  const std::string format = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::string nodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";
  const std::string triangles = "$Elements\n1\n1 2 0 1 2 3\n$EndElements\n";
  const auto expect = [&](const std::string& content, std::string_view fault) {
    const auto broken = file("a.msh", content);
    expect_user_error([&] { static_cast<void>(read_mesh(broken)); }, {"a.msh", fault});
  };
  expect(format, "no section $Nodes");
  expect(format + nodes, "no section $Elements");
  expect(format + triangles + nodes, "$Elements comes before $Nodes");
  expect(format + nodes + triangles,
         "no volume cells (tet4, hex8, wedge6 or tet10), only 3 nodes, 1 triangle3");
  expect(format + nodes + "$Elements\n0\n$EndElements\n", "no volume cells");
}

}  // namespace
}  // namespace evert::test
