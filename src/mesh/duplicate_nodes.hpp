#pragma once
#include "evert/core/index.hpp"
#include "evert/math/vec3.hpp"

#include <span>

namespace evert {

/// Number of points no farther than `tolerance` from one before them.
[[nodiscard]] GlobalIndex count_duplicate_nodes(std::span<const Vec3d> points, double tolerance);

}  // namespace evert
