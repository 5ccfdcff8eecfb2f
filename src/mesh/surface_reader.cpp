#include "evert/mesh/surface_reader.hpp"

#include "evert/shapes/triangle_solid.hpp"

#include "surface_builder.hpp"
#include <algorithm>

namespace evert {

TriangleSurface read_surface(const std::filesystem::path& path) {
  auto extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  using Reader = void (*)(InputCursor&, SurfaceBuilder&);
  const Reader read = extension == ".obj"   ? read_obj
                      : extension == ".off" ? read_off
                      : extension == ".ply" ? read_ply
                      : extension == ".stl" ? read_stl
                                            : nullptr;
  if (read == nullptr)
    throw UserError(path.string() +
                    ": is no surface of triangles by its name: must be .obj, .stl, .ply or .off");
  const auto text = read_whole_file(path);
  InputCursor in(text, path.string());
  SurfaceBuilder surface(in);
  read(in, surface);
  return surface.finish();
}

TriangleSurface read_closed_surface(const std::filesystem::path& path) {
  auto surface = read_surface(path);
  require_closed(surface, path.string());
  return surface;
}

}  // namespace evert
