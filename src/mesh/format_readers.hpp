#pragma once
#include "evert/mesh/mesh.hpp"

#include "input_cursor.hpp"
#include <filesystem>

/// One reader per file format; read_mesh chooses. All throw UserError with the place of what is wrong.
namespace evert {

/// Gmsh 2.2 and 4.1, ASCII and binary.
[[nodiscard]] Mesh read_gmsh(InputCursor& in);
/// Medit .mesh, ASCII.
[[nodiscard]] Mesh read_medit(InputCursor& in);
/// Legacy VTK, ASCII and binary.
[[nodiscard]] Mesh read_vtk(InputCursor& in);
/// VTK XML.
[[nodiscard]] Mesh read_vtu(InputCursor& in);
/// TetGen: `path` is the .node or the .ele file, the other stands beside it.
[[nodiscard]] Mesh read_tetgen(const std::filesystem::path& path);

}  // namespace evert
