#pragma once
#include "evert/mesh/mesh.hpp"

#include <filesystem>

namespace evert {

/// Reads a mesh file: Gmsh 2.2 and 4.1 (.msh, ASCII or binary) or Medit (.mesh, ASCII). The format is
/// recognised by the first line of the file, whatever its name.
///
/// Volume cells become cells, their groups regions: physical groups by their name, or "volume_<number>"
/// without one; Medit references as "ref_<number>"; "default" for cells of a Gmsh file in no group. A volume
/// in several physical groups has the first for its region; the others become node sets. Groups of surfaces,
/// curves and points become node sets: by name, or "surface_<number>", "curve_<number>", "point_<number>".
///
/// Cells of negative volume are kept as they are (see repair.hpp), and so are unused nodes. Not collective;
/// no PETSc. Throws UserError, naming the line, or the byte in binary files, when the file is missing, cannot
/// be read, is cut short or makes no sense, or holds no volume cells.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path);

}  // namespace evert
