#include "evert/contact/support_points.hpp"

#include "evert/shapes/solids.hpp"

#include <cmath>

namespace evert {

bool is_sharp_box(const ImplicitSurface& solid) {
  if (dynamic_cast<const Box*>(&solid) == nullptr) return false;
  const auto corner = solid.bounds().upper;
  return std::abs(solid.signed_distance(corner)) <= 1e-12 * norm(corner);
}

std::vector<SupportPoint> support_points(const ImplicitSurface& solid) {
  constexpr Fineness coarse{.cells = 16};
  const auto [lower, upper] = solid.bounds();
  if (!std::isfinite(norm(upper - lower))) return {};
  if (dynamic_cast<const Sphere*>(&solid) != nullptr) return {{{}, upper[0]}};
  if (dynamic_cast<const Capsule*>(&solid) != nullptr) {
    const Vec3d end{0, upper[1] - upper[0], 0};
    return {{end, upper[0]}, {{}, upper[0]}, {-end, upper[0]}};
  }
  std::vector<SupportPoint> points;
  if (is_sharp_box(solid)) {
    for (const double x : {lower[0], upper[0]})
      for (const double y : {lower[1], upper[1]})
        for (const double z : {lower[2], upper[2]}) points.push_back({{x, y, z}, 0});
    return points;
  }
  for (const auto& point : triangulate(solid, coarse).points) points.push_back({point, 0});
  return points;
}

}  // namespace evert
