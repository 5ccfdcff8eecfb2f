#include "html_obstacles.hpp"

#include "evert/core/error.hpp"
#include "evert/io/surface.hpp"

#include "../mesh/base64.hpp"
#include "html_numbers.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace evert {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Every edge once each way.
bool is_closed(const RunObstacle& obstacle) {
  std::set<Edge> open;
  for (const auto& triangle : obstacle.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge{triangle[k], triangle[(k + 1) % 3]};
      if (open.erase({edge.second, edge.first}) == 0) open.insert(edge);
    }
  return open.empty();
}

/// The box around `points`, cut to that of the bodies and half of its diagonal more.
void add_corners(std::vector<Vec3d>& corners, std::span<const Vec3d> points,
                 const std::pair<Vec3d, Vec3d>& bodies) {
  const double margin = norm(bodies.second - bodies.first) / 2;
  const auto [lower, upper] = bounds_of(points);
  for (auto corner : {lower, upper}) {
    for (std::size_t c = 0; c < 3; ++c)
      corner[c] = std::clamp(corner[c], bodies.first[c] - margin, bodies.second[c] + margin);
    corners.push_back(corner);
  }
}

}  // namespace

ObstacleBytes page_bytes_of_obstacles(const RunReader& run) {
  ObstacleBytes bytes;
  for (const auto& obstacle : run.obstacles()) {
    bytes.fixed += obstacle.triangles.size() * 12 * 4 / 3 + 4;
    bytes.a_frame += run.obstacle_points(0, obstacle).size() * 12 * 4 / 3 + 4;
  }
  return bytes;
}

ShownObstacles shown_obstacles(const RunReader& run, std::span<const std::size_t> frames, std::size_t up,
                               const std::pair<Vec3d, Vec3d>& bodies) {
  ShownObstacles shown;
  shown.points.resize(frames.size());
  std::vector<std::string> bytes(frames.size());
  for (const auto& obstacle : run.obstacles()) {
    if (obstacle.triangles.empty() || !is_closed(obstacle)) continue;
    std::string corners;
    for (const auto& triangle : obstacle.triangles)
      for (const auto corner : triangle) append_number(corners, corner);
    shown.surfaces += to_base64(corners) + '\n';
    for (std::size_t f = 0; f < frames.size(); ++f) {
      auto points = run.obstacle_points(frames[f], obstacle);
      for (auto& point : points) {
        point = upright(point, up);
        for (const double coordinate : point.components) {
          if (!std::isfinite(static_cast<float>(coordinate)))
            throw UserError("frame " + std::to_string(frames[f]) + " of '" + run.path() + "' has obstacle '" +
                            obstacle.name + "' where it cannot be shown");
          append_number(bytes[f], std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
        }
      }
      if (f == 0) shown.point_counts.push_back(points.size());
      add_corners(shown.corners, points, bodies);
    }
  }
  std::ranges::transform(bytes, shown.points.begin(), [](const std::string& b) { return to_base64(b); });
  return shown;
}

}  // namespace evert
