#include "shape_table.hpp"
#include "tables.hpp"
#include <cmath>
#include <functional>
#include <span>

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

/// Throws unless `key`, where it is given, leaves out cubes in the middle: `widths` along the first axes.
void check_cut(const char* key, std::span<const int> widths, const BoxMesh& box, const Value& map,
               const std::string& path) {
  const auto* value = map.find(key);
  if (value == nullptr) return;
  if (map.find("cells") == nullptr)
    fail(*value, join(path, key), "needs 'cells', of which it leaves some out");
  for (std::size_t axis = 0; axis < widths.size(); ++axis)
    if (widths[axis] >= box.cells[axis] || (box.cells[axis] - widths[axis]) % 2 != 0)
      fail(*value, join(path, key),
           "must be in the middle: less than 'cells' by an even number, but is " +
               std::to_string(widths[axis]) + " of " + std::to_string(box.cells[axis]) + " along " +
               std::string(1, "xyz"[axis]));
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
  check_cut("hole", box.hole, box, map, path);
  check_cut("cross", std::array{box.cross, box.cross, box.cross}, box, map, path);
  if (map.find("hole") != nullptr && map.find("cross") != nullptr)
    fail(map, path, "'hole' and 'cross' exclude each other");
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
          .either("cross", &BoxMesh::cross, integer(1, 1'000'000), "20",
                  "Leaves only three bars along x, y and z, so many cubes thick, that meet in the middle.")
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

const Table<WedgeStack>& wedge_stack() {
  static const auto table =
      Table<WedgeStack>(
          "Flat prisms of three wedges each between two regular tetrahedra along z: elements that make steps "
          "short. The tips are the node sets z_min and z_max.")
          .optional("edge_length", &WedgeStack::edge_length, length(), "2", "Of the two tetrahedra.")
          .optional("edge_ratio", &WedgeStack::edge_ratio, number("-", above_up_to(0, 1e6)), "80",
                    "edge_length over the short edges of the wedges.")
          .optional("layers", &WedgeStack::layers, integer(1, 1'000'000), "3", "Prisms.");
  return table;
}

const Table<RoundBar>& round_bar() {
  static const auto table =
      Table<RoundBar>(
          "A bar or a tube around the y axis, of hexahedra or these cut into tetrahedra: a square of cells "
          "in "
          "the middle and rings around it, or rings alone. Node sets: y_min, y_max, surface.")
          .required("radius", &RoundBar::radius, length(), "0.0032", "Of the bar.")
          .required("length", &RoundBar::length, length(), "0.0324", "Along the y axis.")
          .optional("inner_radius", &RoundBar::inner_radius, number("m", at_least(0)), "0.003",
                    "Of a tube; 0: a bar.")
          .optional("quarter", &RoundBar::quarter, integer(1, 10000), "6",
                    "Cells along a quarter of the circumference.")
          .optional("rings", &RoundBar::rings, integer(1, 10000), "6",
                    "Cells from the square, or the inner radius, to the "
                    "surface.")
          .optional("layers", &RoundBar::layers, integer(0, 1000000), "40",
                    "Cells along the axis; 0: about as long as they are wide.")
          .optional("cell", &RoundBar::cell,
                    one_of<RoundBarCells>({{"hex8", RoundBarCells::hex8, "hexahedra"},
                                           {"tet6", RoundBarCells::tet6, "6 tetrahedra a hexahedron"}}),
                    "tet6", "What they are.")
          .then([](RoundBar& bar, const Value& map, const std::string& path) {
            if (bar.inner_radius < bar.radius) return;
            const auto& value = *map.find("inner_radius");
            fail(value, join(path, "inner_radius"),
                 shown(value) + " is not allowed: must be less than the radius");
          });
  return table;
}

const Table<CutCube>& cut_cube() {
  static const auto table =
      Table<CutCube>(
          "A cube of cubes of five tetrahedra each, cut along a plane into two bodies that touch; the cut "
          "leaves bad tetrahedra. Node sets: the faces x_min, ... z_max, and lower_cut and upper_cut, seen "
          "along the normal.")
          .optional("size", &CutCube::size, length(), "1", "Of the edges of the cube.")
          .optional("cells", &CutCube::cells, integer(1, 1000), "8", "Small cubes along each edge.")
          .optional("normal", &CutCube::normal, direction(), "[0, 0.2, 1]", "Of the plane.")
          .optional("through", &CutCube::through, vector3("m"), "[0, 0, 0.1]", "A point of the plane.")
          .optional("snap", &CutCube::snap, number("-", from_to(0, 0.5)), "0",
                    "Nodes nearer to the plane than so many edges of the small cubes are moved onto it. 0 "
                    "cuts as it comes, and may leave arbitrarily flat tetrahedra.");
  return table;
}

const Table<SliverBall>& sliver_ball() {
  static const auto table =
      Table<SliverBall>(
          "A ball with shaken nodes and slivers, tetrahedra of four nodes that nearly lie in a plane, as "
          "meshing by Delaunay's criterion leaves them.")
          .required("radius", &SliverBall::radius, length(), "0.5", "Of the ball.")
          .required("edge_length", &SliverBall::edge_length, length(), "0.05",
                    "Edge of the tetrahedra, about.")
          .optional("slivers", &SliverBall::slivers, number("-", from_to(0, 0.05)), "0.02",
                    "Share of all tetrahedra.")
          .optional("jitter", &SliverBall::jitter, number("-", from_to(0, 0.3)), "0.05",
                    "How far inner nodes are shaken along each axis, in edge_length.")
          .optional("thinnest", &SliverBall::thinnest, number("-", from_to(1e-6, 0.1)), "0.001",
                    "Least distance of the two edges of a sliver that cross, over the longer of them.")
          .optional("seed", &SliverBall::seed, seed_number(), "7", "Of where nodes go and slivers are.")
          .then([](SliverBall& ball, const Value& map, const std::string& path) {
            expect_possible(8 * ball.radius * ball.radius * ball.radius, ball.edge_length, map, path);
          });
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
    keys.alternative("round_bar", std::identity{}, round_bar())
        .alternative("wedge_stack", std::identity{}, wedge_stack())
        .alternative("cut_cube", std::identity{}, cut_cube())
        .alternative("sliver_ball", std::identity{}, sliver_ball());
    return keys;
  }();
  return table;
}

}  // namespace evert
