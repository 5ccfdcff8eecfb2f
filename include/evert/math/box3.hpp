#pragma once
#include "evert/math/vec3.hpp"

#include <algorithm>
#include <limits>

namespace evert {

/// An axis-aligned box, edges included; empty until it includes a point.
struct Box3 {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3d lower{infinity, infinity, infinity};
  Vec3d upper{-infinity, -infinity, -infinity};

  [[nodiscard]] static constexpr Box3 everything() {
    return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  }

  /// By `width` on every side.
  [[nodiscard]] Box3 grown(double width) const {
    const Vec3d all{width, width, width};
    return {lower - all, upper + all};
  }
  void include(const Vec3d& point) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], point[k]);
      upper[k] = std::max(upper[k], point[k]);
    }
  }
  [[nodiscard]] bool contains(const Vec3d& point) const {
    return point[0] >= lower[0] && point[0] <= upper[0] && point[1] >= lower[1] && point[1] <= upper[1] &&
           point[2] >= lower[2] && point[2] <= upper[2];
  }
  [[nodiscard]] bool overlaps(const Box3& other) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (lower[k] > other.upper[k] || other.lower[k] > upper[k]) return false;
    return true;
  }
};

}  // namespace evert
