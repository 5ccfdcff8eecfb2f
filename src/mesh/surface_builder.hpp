#pragma once
#include "evert/shapes/triangle_surface.hpp"

#include "input_cursor.hpp"
#include <span>

namespace evert {

/// Takes points and polygons as files have them.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(const InputCursor& in) : in_(in) {}

  void add_point(const Vec3d& point);
  [[nodiscard]] std::int64_t point_count() const { return static_cast<std::int64_t>(surface_.points.size()); }
  /// `corners`: numbers of points, from 0 on, at least three. Fails at the place read last.
  void add_polygon(std::span<const std::int64_t> corners);

  /// Points at the same place joined, triangles without three corners left out.
  [[nodiscard]] TriangleSurface finish();

 private:
  const InputCursor& in_;
  TriangleSurface surface_;
};

/// One reader per file format. All throw UserError with the place of what is wrong.
void read_obj(InputCursor& in, SurfaceBuilder& surface);
void read_off(InputCursor& in, SurfaceBuilder& surface);
void read_ply(InputCursor& in, SurfaceBuilder& surface);
void read_stl(InputCursor& in, SurfaceBuilder& surface);

}  // namespace evert
