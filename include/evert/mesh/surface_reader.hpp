#pragma once
#include "evert/shapes/triangle_surface.hpp"

#include <filesystem>

namespace evert {

/// A surface of triangles: Wavefront (.obj), STL (.stl, ASCII and binary), PLY (.ply, ASCII and binary of
/// both byte orders) or OFF (.off). Polygons become fans of triangles. Points at the same place become one,
/// since STL and many exporters write one for each triangle; triangles that lose a corner by that go. Throws
/// UserError with the place of what is wrong in the file.
[[nodiscard]] TriangleSurface read_surface(const std::filesystem::path& path);

/// The same, as it can be a solid: see require_closed().
[[nodiscard]] TriangleSurface read_closed_surface(const std::filesystem::path& path);

}  // namespace evert
