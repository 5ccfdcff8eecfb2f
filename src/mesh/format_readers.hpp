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

}  // namespace evert
