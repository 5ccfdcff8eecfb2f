#include "vtk_grid.hpp"

#include "mesh_builder.hpp"
#include <algorithm>
#include <array>
#include <span>

namespace evert {
namespace {

struct VtkCellType {
  int number;
  int dimension;
  int points;  ///< 0: any number
  std::string_view name;
  std::optional<CellType> cell;  ///< none: no volume cell that Evert knows
};

constexpr int voxel = 11;  // a hexahedron with its corners in the order of a grid
constexpr std::array cell_types{
    VtkCellType{1, 0, 1, "vertex", {}},
    VtkCellType{2, 0, 0, "poly-vertex", {}},
    VtkCellType{3, 1, 2, "line", {}},
    VtkCellType{4, 1, 0, "polyline", {}},
    VtkCellType{5, 2, 3, "triangle", {}},
    VtkCellType{6, 2, 0, "triangle strip", {}},
    VtkCellType{7, 2, 0, "polygon", {}},
    VtkCellType{8, 2, 4, "pixel", {}},
    VtkCellType{9, 2, 4, "quadrilateral", {}},
    VtkCellType{10, 3, 4, "tetrahedron", CellType::tet4},
    VtkCellType{voxel, 3, 8, "voxel", CellType::hex8},
    VtkCellType{12, 3, 8, "hexahedron", CellType::hex8},
    VtkCellType{13, 3, 6, "wedge", CellType::wedge6},
    VtkCellType{14, 3, 5, "pyramid", {}},
    VtkCellType{21, 1, 3, "quadratic edge", {}},
    VtkCellType{22, 2, 6, "quadratic triangle", {}},
    VtkCellType{23, 2, 8, "quadratic quadrilateral", {}},
    VtkCellType{24, 3, 10, "quadratic tetrahedron", CellType::tet10},
    VtkCellType{25, 3, 20, "quadratic hexahedron", {}},
    VtkCellType{26, 3, 15, "quadratic wedge", {}},
    VtkCellType{42, 3, 0, "polyhedron", {}},
};

constexpr std::array<std::string_view, 3> kinds_of_groups{"point_", "curve_", "surface_"};

class Assembly {
 public:
  Assembly(const VtkGrid& grid, const InputCursor& in) : grid_(grid), in_(in) {}

  Mesh run() {
    check_sizes();
    for (const auto& point : grid_.points) mesh_.add_node(point);
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < grid_.types.size(); ++cell) {
      const auto end = grid_.ends[cell];
      if (end < begin || end > static_cast<std::int64_t>(grid_.connectivity.size()))
        in_.fail_at(grid_.cells_position, "the points of cell " + std::to_string(cell) + " end at " +
                                              std::to_string(end) + ", outside the list of connectivity");
      add_cell(cell, std::span(grid_.connectivity)
                         .subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
      begin = end;
    }
    add_node_sets();
    return std::move(mesh_).finish(in_.name());
  }

 private:
  void check_sizes() {
    const auto cells = grid_.types.size();
    if (grid_.ends.size() != cells)
      in_.fail_at(grid_.types_position, "there are " + std::to_string(cells) + " cell types, but " +
                                            std::to_string(grid_.ends.size()) + " cells");
    if (!grid_.regions.empty() && grid_.regions.size() != cells)
      in_.fail_at(grid_.types_position, "there are " + std::to_string(cells) + " cells, but " +
                                            std::to_string(grid_.regions.size()) + " numbers of regions");
    if (!grid_.vectors.empty() && grid_.vectors.size() != cells)
      in_.fail_at(grid_.types_position, "there are " + std::to_string(cells) + " cells, but " +
                                            std::to_string(grid_.vectors.size()) + " vectors");
  }

  void add_cell(std::size_t cell, std::span<const std::int64_t> points) {
    const auto& type = type_of(cell);
    if (type.points != 0 && points.size() != static_cast<std::size_t>(type.points))
      in_.fail_at(grid_.cells_position, "cell " + std::to_string(cell) + " is a " + std::string(type.name) +
                                            " with " + std::to_string(points.size()) +
                                            " points; it must have " + std::to_string(type.points));
    for (const auto point : points)
      if (point < 0 || point >= mesh_.node_count())
        in_.fail_at(grid_.cells_position, "cell " + std::to_string(cell) + " has the point " +
                                              std::to_string(point) + "; allowed are 0 to " +
                                              std::to_string(mesh_.node_count() - 1));
    if (!type.cell) {
      mesh_.count_lower_cell(type.name);
      if (grid_.regions.empty()) return;
      const auto kind = kinds_of_groups[static_cast<std::size_t>(type.dimension)];
      mesh_.add_to_node_set(std::string(kind) + std::to_string(grid_.regions[cell]), points);
      return;
    }
    std::array<GlobalIndex, 10> nodes{};
    std::ranges::copy(points, nodes.begin());
    if (type.number == voxel) {
      std::swap(nodes[2], nodes[3]);
      std::swap(nodes[6], nodes[7]);
    }
    const auto place =
        mesh_.add_cell(*type.cell, std::span(nodes).first(points.size()), mesh_.region(region_name(cell)));
    if (!grid_.vectors.empty()) mesh_.set_vector(place, grid_.vectors[cell]);
  }

  [[nodiscard]] const VtkCellType& type_of(std::size_t cell) const {
    const auto number = grid_.types[cell];
    const auto found = std::ranges::find(cell_types, number, &VtkCellType::number);
    const bool known = found != cell_types.end();
    if (known && (found->dimension < 3 || found->cell)) return *found;
    in_.fail_at(grid_.types_position, "cell " + std::to_string(cell) + " is " +
                                          (known ? "a " + std::string(found->name) : "of an unknown type") +
                                          " (VTK type " + std::to_string(number) +
                                          "), which cannot be simulated; allowed are tetrahedra (10, 24), "
                                          "hexahedra (11, 12), wedges (13) and "
                                          "cells of lower dimension");
  }

  [[nodiscard]] std::string region_name(std::size_t cell) const {
    if (grid_.regions.empty()) return "default";
    const auto number = grid_.regions[cell];
    if (number >= 0 && number < static_cast<std::int64_t>(grid_.region_names.size()))
      return grid_.region_names[static_cast<std::size_t>(number)];
    return "region_" + std::to_string(number);
  }

  void add_node_sets() {
    for (const auto& [name, members] : grid_.node_sets) {
      if (members.size() != grid_.points.size())
        in_.fail_at(grid_.cells_position, "the node set '" + name + "' has " +
                                              std::to_string(members.size()) + " numbers for " +
                                              std::to_string(grid_.points.size()) + " points");
      for (std::size_t point = 0; point < members.size(); ++point) {
        const auto node = static_cast<GlobalIndex>(point);
        if (members[point] != 0) mesh_.add_to_node_set(name, {&node, 1});
      }
    }
  }

  const VtkGrid& grid_;
  const InputCursor& in_;
  MeshBuilder mesh_;
};

}  // namespace

bool is_region_array(std::string_view name) {
  constexpr std::array<std::string_view, 6> names{region_array,    "gmsh:physical", "medit:ref",
                                                  "CellEntityIds", "MaterialIDs",   "ElementBlockIds"};
  return std::ranges::find(names, name) != names.end();
}

int vtk_number(CellType type) {
  switch (type) {
    case CellType::tet4:
      return 10;
    case CellType::hex8:
      return 12;
    case CellType::wedge6:
      return 13;
    case CellType::tet10:
      return 24;
  }
  return 0;
}

Mesh mesh_of(const VtkGrid& grid, const InputCursor& in) { return Assembly(grid, in).run(); }

}  // namespace evert
