#include "surface_builder.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace evert {

void SurfaceBuilder::add_point(const Vec3d& point) {
  if (surface_.points.size() == std::numeric_limits<std::int32_t>::max())
    in_.fail("more than 2^31 points, which is the most for a surface");
  surface_.points.push_back(point);
}

void SurfaceBuilder::add_polygon(std::span<const std::int64_t> corners) {
  if (corners.size() < 3)
    in_.fail("a face has " + std::to_string(corners.size()) + " corners, but must have at least 3");
  for (const auto corner : corners)
    if (corner < 0 || corner >= point_count())
      in_.fail("a face names a point that is not there: the file has " + std::to_string(point_count()) +
               " before it");
  const auto at = [&](std::size_t k) { return static_cast<std::int32_t>(corners[k]); };
  for (std::size_t k = 2; k < corners.size(); ++k) surface_.triangles.push_back({at(0), at(k - 1), at(k)});
}

TriangleSurface SurfaceBuilder::finish() {
  auto& points = surface_.points;
  std::vector<std::int32_t> by_place(points.size()), first_there(points.size());
  std::iota(by_place.begin(), by_place.end(), 0);
  const auto place = [&](std::int32_t p) { return points[static_cast<std::size_t>(p)].components; };
  std::sort(by_place.begin(), by_place.end(), [&](std::int32_t a, std::int32_t b) {
    return place(a) != place(b) ? place(a) < place(b) : a < b;
  });
  for (std::size_t i = 0; i < by_place.size(); ++i) {
    const bool is_again = i > 0 && place(by_place[i]) == place(by_place[i - 1]);
    const auto self = static_cast<std::size_t>(by_place[i]);
    first_there[self] =
        is_again ? first_there[static_cast<std::size_t>(by_place[i - 1])] : static_cast<std::int32_t>(self);
  }
  for (auto& triangle : surface_.triangles)
    for (auto& corner : triangle) corner = first_there[static_cast<std::size_t>(corner)];
  std::erase_if(surface_.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  return std::move(surface_);
}

}  // namespace evert
