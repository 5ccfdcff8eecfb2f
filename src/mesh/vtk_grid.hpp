#pragma once
#include "evert/mesh/mesh.hpp"

#include "input_cursor.hpp"
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What legacy VTK and VTU files have in common.
namespace evert {

/// Names of our own arrays in these files.
inline constexpr std::string_view region_array = "region";              ///< cell data: number of the region
inline constexpr std::string_view region_names_array = "region_names";  ///< field data: names of the regions
inline constexpr std::string_view node_set_prefix = "node_set:";        ///< point data: 1 for members, else 0

/// True for cell arrays that number the regions: ours, and those of Gmsh, meshio and ParaView.
[[nodiscard]] bool is_region_array(std::string_view name);

/// VTK's number of a cell type.
[[nodiscard]] int vtk_number(CellType type);

/// An unstructured grid as VTK stores it.
struct VtkGrid {
  std::vector<Vec3d> points;
  std::vector<std::int64_t> connectivity;  ///< points of all cells
  std::vector<std::int64_t> ends;          ///< per cell: end of its points in `connectivity`
  std::vector<std::int64_t> types;         ///< per cell: VTK's number
  std::vector<std::int64_t> regions;       ///< per cell, or empty
  std::vector<Vec3d> vectors;              ///< per cell, or empty: those that are wanted
  std::vector<std::string> region_names;   ///< of regions 0, 1, ..., or empty
  std::vector<std::pair<std::string, std::vector<std::int64_t>>>
      node_sets;  ///< name and a number per point, ≠ 0: in

  std::size_t cells_position = 0;  ///< in the file, for messages
  std::size_t types_position = 0;
};

/// Regions without a name are called "region_<number>", and the nodes of cells of lower dimension become the
/// node sets "surface_<number>", "curve_<number>" and "point_<number>" where the cells are numbered. Throws
/// UserError through `in` when the parts contradict each other or a cell is of a type that cannot be
/// simulated.
[[nodiscard]] Mesh mesh_of(const VtkGrid& grid, const InputCursor& in);

}  // namespace evert
