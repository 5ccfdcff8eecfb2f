#pragma once
#include "evert/mesh/mesh.hpp"

#include "input_cursor.hpp"
#include "vector_field.hpp"
#include <filesystem>

/// One reader per file format; read_mesh chooses. All throw UserError with the place of what is wrong; those
/// of formats that have cell fields also when the one that is wanted is not there.
namespace evert {

/// Gmsh 2.2 and 4.1, ASCII and binary.
[[nodiscard]] Mesh read_gmsh(InputCursor& in, VectorField& vectors);
/// Medit .mesh, ASCII.
[[nodiscard]] Mesh read_medit(InputCursor& in);
/// Legacy VTK, ASCII and binary.
[[nodiscard]] Mesh read_vtk(InputCursor& in, VectorField& vectors);
/// VTK XML.
[[nodiscard]] Mesh read_vtu(InputCursor& in, VectorField& vectors);
/// TetGen: `path` is the .node or the .ele file, the other stands beside it.
[[nodiscard]] Mesh read_tetgen(const std::filesystem::path& path);

}  // namespace evert
