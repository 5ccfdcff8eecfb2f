#include "evert/mesh/mesh_reader.hpp"

#include "mesh_files.hpp"

namespace evert::test {
namespace {

using VtkReader = MeshFileTest;
using Names = std::vector<std::string>;
using Nodes = std::vector<GlobalIndex>;

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
SCALARS quality float 1
LOOKUP_TABLE default
0.1 nan 0.3
SCALARS MaterialIDs int 1
LOOKUP_TABLE default
8 5 6
POINT_DATA 5
VECTORS velocity double
0 0 0 0 0 0 0 0 0 0 0 0 0 0 0
)";

constexpr std::string_view xml = R"(<?xml version="1.0"?>
<!-- two tetrahedra in two pieces -->
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray>
</Cells>
</Piece>
<Piece NumberOfPoints='8' NumberOfCells='1'>
<CellData Scalars="region"><DataArray type="Int32" Name="region" format="ascii">3</DataArray></CellData>
<Points>
<DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1
</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">11</DataArray>
</Cells>
</Piece>
</UnstructuredGrid>
</VTKFile>
)";

TEST_F(VtkReader, reads_legacy_text) {
  const auto mesh = read_mesh(file("a.vtk", legacy));
  EXPECT_EQ(mesh.node_count(), 5);
  EXPECT_EQ(mesh.block(CellType::tet4)->nodes, (Nodes{0, 1, 2, 3, 1, 2, 3, 4}));
  EXPECT_EQ(regions_of_cells(mesh), (Names{"region_5", "region_6"}));
  ASSERT_EQ(mesh.node_sets.size(), 1U);
  EXPECT_EQ(mesh.node_sets[0].name, "surface_8");
}

TEST_F(VtkReader, reads_pieces_and_voxels) {
  const auto mesh = read_mesh(file("a.vtu", xml));
  EXPECT_EQ(mesh.node_count(), 12);
  EXPECT_EQ(mesh.block(CellType::tet4)->nodes, (Nodes{0, 1, 2, 3}));
  EXPECT_EQ(mesh.block(CellType::hex8)->nodes, (Nodes{4, 5, 7, 6, 8, 9, 11, 10}));
  EXPECT_EQ(regions_of_cells(mesh), (Names{"region_0", "region_3"}));
}

struct Case {
  std::string_view from;
  std::string_view to;
  std::string_view place;
  std::string_view fault;
};

std::string with(std::string_view text, const Case& change) {
  std::string result(text);
  const auto at = result.find(change.from);
  EXPECT_NE(at, std::string::npos) << change.from;
  return result.replace(at, change.from.size(), change.to);
}

TEST_F(VtkReader, names_the_line_of_what_is_wrong_in_legacy_files) {
  for (const auto& change : std::vector<Case>{
           {"Version 2.0", "Version 6.0", "a.vtk:1:", "allowed are 1.0 to 5.1"},
           {"ASCII", "TEXT", "a.vtk:3:", "ASCII or BINARY"},
           {"UNSTRUCTURED_GRID", "POLYDATA", "a.vtk:4:", "allowed is UNSTRUCTURED_GRID"},
           {"5 float", "5 flaot", "a.vtk:5:", "'flaot' is no number type"},
           {"5 float", "-5 float", "a.vtk:5:", "must not be negative"},
           {"5 float", "5000000 float", "a.vtk:5:", "more than the remaining"},
           {"0 0 1  1 1 1", "0 0 1  1 inf 1", "a.vtk:7:", "finite"},
           {"4 1 2 3 4\n", "4 1 2 3 5\n", "a.vtk:11:", "there is no point 5; allowed are 0 to 4"},
           {"4 1 2 3 4\n", "4 1 2 3 -4\n", "a.vtk:11:", "there is no point -4"},
           {"4 1 2 3 4\n", "9000000 1 2 3 4\n", "a.vtk:11:", "more than the remaining"},
           {"CELLS 3 14", "CELLS 3 15", "a.vtk:11:", "has 14 numbers, but promises 15"},
           {"3 0 1 2", "2 0 1 2", "a.vtk:10:", "has 8 numbers, but promises 14"},
           {"5 10\n10", "5 10\n14", "a.vtk:12:", "is a pyramid (VTK type 14), which cannot be simulated"},
           {"5 10\n10", "5 10\n99", "a.vtk:12:", "unknown type (VTK type 99)"},
           {"5 10\n10", "5 10\n12", "a.vtk:8:", "is a hexahedron with 4 points; it must have 8"},
           {"CELL_DATA 3", "CELL_DATA 4", "a.vtk:15:", "data for 4 of 3 cells"},
           {"SCALARS quality", "SKALARS quality", "a.vtk:16:", "no keyword of VTK's"},
           {"\nCELL_TYPES 3\n5 10\n10", "", "a.vtk", "data for 3 of 0 cells"},
       }) {
    const auto broken = file("a.vtk", with(legacy, change));
    expect_user_error([&] { static_cast<void>(read_mesh(broken)); }, {change.place, change.fault});
  }
}

TEST_F(VtkReader, names_the_line_of_what_is_wrong_in_xml) {
  for (const auto& change : std::vector<Case>{
           {"\"UnstructuredGrid\"", "\"PolyData\"", "a.vtu:3:", "allowed is UnstructuredGrid"},
           {"LittleEndian", "Middle", "a.vtu:3:", "byte_order"},
           {"version=\"0.1\"", "compressor=\"vtkLZ4DataCompressor\"", "a.vtu:3:", "vtkZLibDataCompressor"},
           {"version=\"0.1\"", "version=0.1", "a.vtu:3:", "name=\"value\""},
           {"NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"", "a.vtu:6:", "has 12 numbers, but must have"},
           {"NumberOfCells=\"1\"", "NumberOfCells=\"x\"", "a.vtu:5:", "NumberOfCells"},
           {"0 0 0 1 0 0 0 1 0 0 0 1<", "0 0 0 1 0 0 0 1 0 0 0 nan<", "a.vtu:6:", "finite"},
           {">0 1 2 3<", ">0 1 2 4<", "a.vtu:8:", "there is no point 4; the piece has 4"},
           {">0 1 2 3<", ">0 1 2 b<", "a.vtu:8:", "whole number, not 'b'"},
           {">4<", ">7<", "a.vtu:9:", "outside the connectivity"},
           {">4<", ">3<", "a.vtu:", "it must have 4"},
           {">10<", ">10 10<", "a.vtu:10:", "has 2 numbers, but must have 1"},
           {">10<", ">14<", "a.vtu:", "pyramid"},
           {"\"types\"", "\"typen\"", "a.vtu:5:", "no array 'types'"},
           {"\"UInt8\"", "\"Uint8\"", "a.vtu:10:", "'Uint8' is no number type"},
           {"\"offsets\" format=\"ascii\"", "\"offsets\" format=\"binary\"",
            "a.vtu:9:", "'offsets' is cut short"},
           {"\"offsets\" format=\"ascii\">4", "\"offsets\" format=\"binary\">AA!A////AAAA",
            "a.vtu:9:", "not written in base64"},
           {"\"offsets\" format=\"ascii\">4",
            "\"offsets\" format=\"binary\">////fwQAAAA=", "a.vtu:9:", "cut short"},
           {"\"offsets\" format=\"ascii\"", "\"offsets\" format=\"appended\" offset=\"9\"",
            "a.vtu:9:", "behind the end"},
           {"\"offsets\" format=\"ascii\"", "\"offsets\" format=\"hex\"",
            "a.vtu:9:", "allowed are ascii, binary and appended"},
           {"</VTKFile>", "", "a.vtu:", "an XML tag is expected (truncated?)"},
       }) {
    const auto broken = file("a.vtu", with(xml, change));
    expect_user_error([&] { static_cast<void>(read_mesh(broken)); }, {change.place, change.fault});
  }
}

TEST_F(VtkReader, allocates_nothing_that_compressed_data_cannot_hold) {
  // Header: one block of 2^31 bytes in 8 compressed bytes.
  std::string content(xml);
  const std::string array = "\"offsets\" format=\"ascii\">4";
  content.replace(content.find(array), array.size(),
                  "\"offsets\" format=\"binary\">AQAAAAAAAIAAAAAACAAAAA==eJxjYAAAAAA=");
  content.replace(content.find("version=\"0.1\""), 13, "compressor=\"vtkZLibDataCompressor\"");
  const auto bomb = file("a.vtu", content);
  expect_user_error([&] { static_cast<void>(read_mesh(bomb)); },
                    {"a.vtu:9:", "more data than its compressed bytes can hold"});
}

}  // namespace
}  // namespace evert::test
