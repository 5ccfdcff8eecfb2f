#pragma once
#include "evert/mesh/mesh.hpp"

#include <filesystem>
#include <string_view>

namespace evert {

/// Reads a mesh file: Gmsh 2.2 and 4.1 (.msh, ASCII or binary), Medit (.mesh, ASCII), legacy VTK (.vtk, ASCII
/// or binary), VTK XML (.vtu: text, base64 or appended, zlib or not) or TetGen (.node or .ele, the other
/// beside it). TetGen is recognised by the extension, the others by their first line, whatever the name.
///
/// Volume cells become cells, their groups regions. Groups of cells of lower dimension become node sets:
/// - Gmsh: physical groups by their name, or "volume_<number>", "surface_<number>", "curve_<number>",
///   "point_<number>" without one; "default" for cells in no group. A volume in several physical groups has
///   the first for its region; the others become node sets.
/// - Medit: references as "ref_<number>"; for references other than 0 "surface_<number>", "curve_<number>"
/// and, of
///   vertices, "vertices_<number>".
/// - VTK: the first integer cell array called region, gmsh:physical, medit:ref, CellEntityIds, MaterialIDs or
///   ElementBlockIds as "region_<number>", or by the names that write_mesh adds; "surface_<number>" and so
///   on.
/// - TetGen: the first attribute as "region_<number>"; boundary markers other than 0 as "marker_<number>".
///
/// `cell_vectors`, unless it is "", names a cell field of vectors to be read into CellBlock::vectors: an
/// $ElementData of Gmsh with 3 components (its first time step; cells that it leaves out have the vector 0)
/// or a cell array of VTK with 3 components. Medit and TetGen files have none.
///
/// Cells of negative volume are kept as they are, and so are unused nodes: see repair.hpp. Not collective; no
/// PETSc. Throws UserError, naming the line, or the byte in binary files, when the file is missing, cannot be
/// read, is cut short or makes no sense, or holds no volume cells or no
/// such field.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path, std::string_view cell_vectors = {});

}  // namespace evert
