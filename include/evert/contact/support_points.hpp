#pragma once
#include "evert/shapes/implicit_surface.hpp"

#include <vector>

namespace evert {

/// A ball that lies within a solid and touches its surface; a corner where the radius is 0.
struct SupportPoint {
  Vec3d center{};
  double radius = 0;
};

/// The places where a solid touches other solids: the ball itself, the ends and the middle of a capsule, the
/// corners of a box, points of its surface else. None of a solid without end.
[[nodiscard]] std::vector<SupportPoint> support_points(const ImplicitSurface& solid);

/// A box whose edges are not rounded.
[[nodiscard]] bool is_sharp_box(const ImplicitSurface& solid);

}  // namespace evert
