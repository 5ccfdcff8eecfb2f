#pragma once
#include "evert/math/vec3.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace evert {

class ImplicitSurface;

/// A triangle by the numbers of its points, counter-clockwise seen from outside.
using Triangle = std::array<std::int32_t, 3>;

struct TriangleSurface {
  std::vector<Vec3d> points;  ///< [m]
  std::vector<Triangle> triangles;
};

/// How finely a surface is drawn.
struct Fineness {
  int cells = 48;      ///< along the longest side of the solid's box; the other sides have 8 at least
  double extent = 10;  ///< [m] side of the part that is drawn of a solid without end
};

/// The surface of a solid in its own frame, for pictures: closed unless the solid goes on beyond `extent`.
/// Edges and corners stay sharp where they are not finer than a cell. Throws UserError when nothing is
/// inside.
[[nodiscard]] TriangleSurface triangulate(const ImplicitSurface& solid, const Fineness& fineness = {});

}  // namespace evert
