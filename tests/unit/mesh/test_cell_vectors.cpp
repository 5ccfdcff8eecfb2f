#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/quadratic.hpp"

#include "mesh_files.hpp"

/// Fields of vectors per cell: from files, and with their cells from then on.
namespace evert::test {
namespace {

using CellVectors = MeshFileTest;
using Vectors = std::vector<Vec3d>;

constexpr std::string_view gmsh22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
$EndNodes
$Elements
3
70 4 0 2 3 4 5
9 2 0 1 2 3
4 4 0 1 2 3 4
$EndElements
)";

constexpr std::string_view gmsh41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 5 1 5
3 1 0 5
1
2
3
4
5
0 0 0
1 0 0
0 1 0
0 0 1
1 1 1
$EndNodes
$Elements
2 3 4 70
3 1 4 2
70 2 3 4 5
4 1 2 3 4
2 1 2 1
9 1 2 3
$EndElements
)";

constexpr std::string_view temperature = R"($ElementData
1
"temperature"
1
nan
3
0
1
1
70 451
$EndElementData
)";

constexpr std::string_view fibres = R"($ElementData
2
"fibres"
"an interpolation scheme"
1
0.0
4
0
3
3
0
4 1 2 3
9 7 7 7
70 -0.5 0 1e-3
$EndElementData
)";

constexpr std::string_view later = R"($ElementData
1
"fibres"
1
1.0
3
1
3
1
4 9 9 9
$EndElementData
)";

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string all;
  for (const auto part : parts) all += part;
  return all;
}

TEST_F(CellVectors, of_gmsh_follow_the_numbers_of_elements) {
  for (const auto mesh_text : {gmsh22, gmsh41}) {
    const auto a = file("a.msh", joined({mesh_text, temperature, fibres, later}));
    const auto mesh = read_mesh(a, "fibres");
    EXPECT_EQ(mesh.block(CellType::tet4)->vectors, (Vectors{{-0.5, 0, 1e-3}, {1, 2, 3}}));
    EXPECT_TRUE(read_mesh(a).block(CellType::tet4)->vectors.empty()) << "nobody asked for them";
  }
}

TEST_F(CellVectors, left_out_by_gmsh_are_zero) {
  auto text = joined({gmsh22, fibres});
  text.replace(text.find("\n3\n0\n4 1"), 5, "\n2\n0\n");
  text.erase(text.find("70 -0.5"), std::string_view("70 -0.5 0 1e-3\n").size());
  EXPECT_EQ(read_mesh(file("a.msh", text), "fibres").block(CellType::tet4)->vectors,
            (Vectors{{0, 0, 0}, {1, 2, 3}}));
}

TEST_F(CellVectors, of_binary_gmsh_files) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    Bytes bytes(order);
    bytes.text("$MeshFormat\n2.2 1 8\n").put(1).text("\n$EndMeshFormat\n$Nodes\n4\n");
    const double positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 4; ++i)
      bytes.put(i + 1).put(positions[i][0]).put(positions[i][1]).put(positions[i][2]);
    bytes.text("\n$EndNodes\n$Elements\n1\n").put_all({4, 1, 0, 12, 1, 2, 3, 4}).text("\n$EndElements\n");
    bytes.text("$ElementData\n1\n\"fibres\"\n1\n0\n3\n0\n3\n1\n").put(12);
    bytes.put_all({0.25, -4.0, 1e-200}).text("\n$EndElementData\n");
    EXPECT_EQ(read_mesh(file("a.msh", bytes.str()), "fibres").block(CellType::tet4)->vectors,
              (Vectors{{0.25, -4.0, 1e-200}}));
  }
}

constexpr std::string_view legacy = R"(# vtk DataFile Version 2.0
a title
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0  1 0 0  0 1 0
0 0 1  1 1 1
CELLS 3 14
3 0 1 2
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 3
5 10
10
CELL_DATA 3
VECTORS velocity double
nan 0 0 0 0 0 0 0 0
FIELD attributes 2
fibres 3 3 float
9 9 9
1 0 0.5
0 -2 0
density 1 3 double
1 2 3
)";

TEST_F(CellVectors, of_legacy_vtk) {
  EXPECT_EQ(read_mesh(file("a.vtk", legacy), "fibres").block(CellType::tet4)->vectors,
            (Vectors{{1, 0, 0.5}, {0, -2, 0}}));
}

constexpr std::string_view xml = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<CellData><DataArray type="Float32" Name="fibres" NumberOfComponents="3" format="ascii">1 2 0.5</DataArray></CellData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray>
</Cells>
</Piece>
</UnstructuredGrid>
</VTKFile>
)";

TEST_F(CellVectors, of_vtu) {
  EXPECT_EQ(read_mesh(file("a.vtu", xml), "fibres").block(CellType::tet4)->vectors, (Vectors{{1, 2, 0.5}}));
}

TEST_F(CellVectors, name_the_place_of_what_is_wrong) {
  struct Case {
    std::string name, text, field, place, fault;
  };
  const auto with = [](std::string text, std::string_view from, std::string_view to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const auto msh = joined({gmsh22, temperature, fibres});
  for (const auto& [name, text, field, place, fault] : std::vector<Case>{
           {"a.msh", msh, "fibre", "a.msh: ", "no cell field of vectors called 'fibre'; it has fibres"},
           {"a.msh", std::string(gmsh22), "fibres", "a.msh: ", "it has none"},
           {"a.msh", msh, "temperature", "a.msh:26:", "has 1 components; it must have 3"},
           {"a.msh", with(msh, "1e-3", "inf"), "fibres", "a.msh:42:", "finite"},
           {"a.msh", with(msh, "70 -0.5", "71 -0.5"), "fibres", "a.msh:42:", "there is no element 71"},
           {"a.msh", with(msh, "70 -0.5 0 1e-3\n", ""), "fibres", "a.msh:42:", "must be a whole number"},
           {"a.msh", with(msh, "\n3\n0\n4 1", "\n3000000\n0\n4 1"), "fibres", "a.msh", "remaining"},
           {"a.msh", with(msh, "4\n0\n3\n3\n0\n", "2\n0\n3\n"), "fibres", "a.msh:35:", "3 integer tags"},
           {"a.msh", with(msh, "\"fibres\"", "fibres"), "fibres", "a.msh:31:", "double quotes"},
           {"a.vtk", std::string(legacy), "fiber", "a.vtk: ", "it has velocity or fibres"},
           {"a.vtk", std::string(legacy), "density", "a.vtk:23:", "has 1 components"},
           {"a.vtk", std::string(legacy), "velocity", "a.vtk:17:", "finite"},
           {"a.vtu", std::string(xml), "fiber", "a.vtu: ", "did you mean 'fibres'?"},
           {"a.vtu", with(std::string(xml), "1 2 0.5", "1 2"), "fibres", "a.vtu:5:", "must have 3"},
           {"a.vtu", with(std::string(xml), "\"3\" format=\"ascii\">1", "\"1\" format=\"ascii\">1"), "fibres",
            "a.vtu", "it must have 3"},
           {"a.mesh",
            "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
            "Tetrahedra 1\n1 2 3 4 0\nEnd\n",
            "fibres", "a.mesh: ", "it has none"},
       }) {
    const auto broken = file(name, text);
    expect_user_error([&, wanted = field] { static_cast<void>(read_mesh(broken, wanted)); }, {place, fault});
  }
  const auto before = joined({"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", fibres});
  expect_user_error([&] { static_cast<void>(read_mesh(file("b.msh", before), "fibres")); },
                    {"b.msh:4:", "before $Elements"});
}

TEST_F(CellVectors, before_the_cells_are_skipped_where_none_are_wanted) {
  std::string moved(gmsh22);
  moved.insert(moved.find("$Elements"), fibres);
  EXPECT_FALSE(read_mesh(file("early.msh", moved)).cells.empty());
}

TEST_F(CellVectors, stay_when_tetrahedra_become_quadratic) {
  auto mesh = read_mesh(file("a.msh", joined({gmsh22, fibres})), "fibres");
  const auto before = mesh.block(CellType::tet4)->vectors;
  make_quadratic(mesh);
  EXPECT_EQ(mesh.block(CellType::tet10)->vectors, before);
}

}  // namespace
}  // namespace evert::test
