#include "evert/mesh/mesh_reader.hpp"

#include "evert/core/error.hpp"

#include "format_readers.hpp"
#include "vector_field.hpp"
#include <string>

namespace evert {

Mesh read_mesh(const std::filesystem::path& path, std::string_view cell_vectors) {
  VectorField vectors(cell_vectors);
  const auto without_vectors = [&](Mesh mesh) {
    vectors.expect_found(path.string());
    return mesh;
  };
  if (path.extension() == ".node" || path.extension() == ".ele") return without_vectors(read_tetgen(path));
  const auto text = read_whole_file(path);
  InputCursor in(text, path.string());
  const auto start = in.peek_word();
  if (start.starts_with('$')) return read_gmsh(in, vectors);
  if (start.starts_with("MeshVersionFormatted")) return without_vectors(read_medit(in));
  if (in.rest().starts_with("# vtk")) return read_vtk(in, vectors);
  if (start.starts_with('<')) return read_vtu(in, vectors);
  throw UserError(
      path.string() +
      ": is in no mesh format that is read; allowed are Gmsh (.msh), Medit (.mesh), VTK (.vtk, .vtu) and "
      "TetGen (.node with .ele)");
}

}  // namespace evert
