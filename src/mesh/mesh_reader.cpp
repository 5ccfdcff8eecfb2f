#include "evert/mesh/mesh_reader.hpp"

#include "evert/core/error.hpp"

#include "format_readers.hpp"
#include <string>
#include <string_view>

namespace evert {

Mesh read_mesh(const std::filesystem::path& path) {
  if (path.extension() == ".node" || path.extension() == ".ele") return read_tetgen(path);
  const auto text = read_whole_file(path);
  InputCursor in(text, path.string());
  const auto start = in.peek_word();
  if (start.starts_with('$')) return read_gmsh(in);
  if (start.starts_with("MeshVersionFormatted")) return read_medit(in);
  if (in.rest().starts_with("# vtk")) return read_vtk(in);
  if (start.starts_with('<')) return read_vtu(in);
  throw UserError(
      path.string() +
      ": is in no mesh format that is read; allowed are Gmsh (.msh), Medit (.mesh), VTK (.vtk, .vtu) and "
      "TetGen (.node with .ele)");
}

}  // namespace evert
