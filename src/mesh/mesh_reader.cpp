#include "evert/mesh/mesh_reader.hpp"

#include "evert/core/error.hpp"

#include "format_readers.hpp"
#include <string>
#include <string_view>

namespace evert {

Mesh read_mesh(const std::filesystem::path& path) {
  const auto text = read_whole_file(path);
  InputCursor in(text, path.string());
  const auto start = in.peek_word();
  if (start.starts_with("$")) return read_gmsh(in);
  if (start.starts_with("MeshVersionFormatted")) return read_medit(in);
  throw UserError(path.string() + ": is in no known mesh format; allowed are Gmsh 2.2 and 4.1, Medit");
}

}  // namespace evert
