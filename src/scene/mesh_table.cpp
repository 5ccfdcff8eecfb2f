#include "shape_table.hpp"
#include "tables.hpp"
#include <cmath>
#include <functional>

/// The meshes that a body can have: a file, or one of the generators.
namespace evert {

using namespace schema;

namespace {

constexpr double most_cells = 1e9;

/// Throws when a volume [m^3] filled with cells of an edge length would not fit into memory by far.
void expect_possible(double volume, double edge_length, const Value& map, const std::string& path) {
  const double cells = 12 * volume / (edge_length * edge_length * edge_length);
  if (cells <= most_cells) return;
  const auto* value = map.find("edge_length");
  fail(*value, join(path, "edge_length"),
       shown(*value) + " is too short for this size: it makes more than 1e9 cells");
}

Type<double> length() { return number("m", above(0)); }

const Table<FileMesh>& file_mesh() {
  static const auto table =
      Table<FileMesh>("A mesh file.")
          .required("file", &FileMesh::path, text("path"), "armadillo.msh",
                    "Gmsh 2.2 or 4.1 (.msh), Medit (.mesh), legacy VTK (.vtk), VTU (.vtu) or TetGen (.node "
                    "beside .ele). "
                    "Relative to the scene file; in -set, to the working directory.")
          .optional("groups", &FileMesh::groups, sequence_of(text("name")), "[muscle, tendon]",
                    "Named volume groups to keep; without it, all cells.");
  return table;
}

void check_hole(const BoxMesh& box, const Value& map, const std::string& path) {
  const auto* hole = map.find("hole");
  if (hole == nullptr) return;
  if (map.find("cells") == nullptr)
    fail(*hole, join(path, "hole"), "needs 'cells', of which it leaves some out");
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (box.hole[axis] >= box.cells[axis] || (box.cells[axis] - box.hole[axis]) % 2 != 0)
      fail(*hole, join(path, "hole"),
           "must be in the middle: along x and y less than 'cells' by an even number, but is " +
               std::to_string(box.hole[axis]) + " of " + std::to_string(box.cells[axis]) + " along " +
               std::string(1, "xy"[axis]));
}

void finish_box(BoxMesh& box, const Value& map, const std::string& path) {
  const bool by_size = map.find("size") != nullptr;
  const bool by_corners = map.find("min") != nullptr && map.find("max") != nullptr;
  if (by_size == by_corners || (by_size && (map.find("min") != nullptr || map.find("max") != nullptr)))
    fail(map, path, "needs either 'size' (centred at the origin) or both 'min' and 'max'");
  if (by_size) {
    box.max = 0.5 * box.size;
    box.min = -box.max;
  }
  box.size = box.max - box.min;
  for (std::size_t i = 0; i < 3; ++i)
    if (!(box.size[i] > 0))
      fail(map, join(path, "max"), "must exceed min, but does not along " + std::string(1, "xyz"[i]));
  if ((map.find("cells") != nullptr) == (map.find("edge_length") != nullptr))
    fail(map, path, "needs either 'cells' or 'edge_length'");
  if (map.find("edge_length") != nullptr)
    expect_possible(box.size[0] * box.size[1] * box.size[2], box.edge_length, map, path);
  else if (static_cast<double>(box.cells[0]) * box.cells[1] * box.cells[2] > most_cells)
    fail(*map.find("cells"), join(path, "cells"), "are too many: at most 1e9 in all");
  check_hole(box, map, path);
}

const Table<BoxMesh>& box_mesh() {
  static const auto table =
      Table<BoxMesh>("A box. Its faces are the node sets x_min, x_max, y_min, y_max, z_min and z_max.")
          .either("size", &BoxMesh::size, vector3("m", above(0)), "[1, 0.5, 0.5]",
                  "Lengths of the edges; the box is centred at the origin.")
          .either("min", &BoxMesh::min, vector3("m"), "[0, 0, 0]", "Lowest corner; with max instead of size.")
          .either("max", &BoxMesh::max, vector3("m"), "[1, 0.5, 0.5]",
                  "Highest corner; with min instead of size.")
          .either("cells", &BoxMesh::cells, array_of<3>(integer(1, 1'000'000), "whole numbers"),
                  "[20, 10, 10]", "Cubes along x, y and z, each cut into cells; instead of edge_length.")
          .either("edge_length", &BoxMesh::edge_length, length(), "0.05",
                  "Edge of the cubes, about; instead of cells.")
          .either("hole", &BoxMesh::hole, array_of<2>(integer(1, 1'000'000), "whole numbers"), "[6, 4]",
                  "Cubes along x and y that are left out in the middle, all the way along z: a square ring.")
          .optional("cell", &BoxMesh::cell,
                    one_of<BoxCells>({{"bcc", BoxCells::bcc, "tetrahedra of the body-centred cubic lattice"},
                                      {"tet6", BoxCells::tet6, "6 tetrahedra a cube"},
                                      {"tet5", BoxCells::tet5, "5 tetrahedra a cube"},
                                      {"hex8", BoxCells::hex8, "hexahedra"},
                                      {"wedge6", BoxCells::wedge6, "2 wedges a cube, along z"}}),
                    "tet6", "What the cubes are cut into.")
          .then(finish_box);
  return table;
}

}  // namespace

const Table<MeshConfig>& mesh_table() {
  static const auto table = [] {
    Table<MeshConfig> keys("A mesh: read from a file or generated, centred at the origin.");
    keys.chosen_by("generate", "The shape to generate.")
        .alternative_by_key("file", std::identity{}, file_mesh())
        .alternative("box", std::identity{}, box_mesh());
    add_filled_shapes(keys);
    return keys;
  }();
  return table;
}

}  // namespace evert
