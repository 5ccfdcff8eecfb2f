#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"
#include "evert/shapes/triangle_solid.hpp"
#include "evert/shapes/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace evert {
namespace {

std::string shown(const Vec3d& x) { return formatted("(%g, %g, %g)", x[0], x[1], x[2]); }

const Vec3d& point(const TriangleSurface& surface, std::size_t triangle, std::size_t k) {
  return surface.points[static_cast<std::size_t>(surface.triangles[triangle][k])];
}

void require_areas(const TriangleSurface& surface, const std::string& name) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto &a = point(surface, t, 0), &b = point(surface, t, 1), &c = point(surface, t, 2);
    if (!(norm(cross(b - a, c - a)) > 1e-14 * (dot(b - a, b - a) + dot(c - a, c - a))))
      throw UserError(name + formatted(": triangle %zu at ", t + 1) + shown(a) + " has no area");
  }
}

void require_closed_edges(const TriangleSurface& surface, const std::string& name) {
  struct Use {
    std::int32_t low, high;
    bool rises;
    std::size_t triangle;
  };
  std::vector<Use> uses;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), a < b, t});
    }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  for (std::size_t i = 0; i < uses.size();) {
    auto end = i + 1;
    while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) ++end;
    const auto edge = "the edge from " + shown(surface.points[static_cast<std::size_t>(uses[i].low)]) +
                      " to " + shown(surface.points[static_cast<std::size_t>(uses[i].high)]);
    const auto triangle = formatted("of triangle %zu", uses[i].triangle + 1);
    if (end - i == 1)
      throw UserError(name + ": the surface is open: " + edge + " " + triangle + " has no other triangle");
    if (end - i > 2)
      throw UserError(name + ": " + edge + " " + triangle + formatted(" has %zu triangles", end - i) +
                      ": must be 2");
    if (uses[i].rises == uses[i + 1].rises)
      throw UserError(
          name + formatted(": triangles %zu and %zu at ", uses[i].triangle + 1, uses[i + 1].triangle + 1) +
          edge + " turn opposite ways round: all must be counter-clockwise seen from outside");
    i = end;
  }
}

double signed_volume(const TriangleSurface& surface) {
  double six_volumes = 0;
  const auto& origin = surface.points.front();  // near the surface, so that nothing cancels
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    six_volumes += dot(point(surface, t, 0) - origin,
                       cross(point(surface, t, 1) - origin, point(surface, t, 2) - origin));
  return six_volumes / 6;
}

double orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(a - d, cross(b - d, c - d));
}

/// Whether the segment passes through the inside of the triangle. Touching is not counted.
bool pierces(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double side_from = orientation(a, b, c, from), side_to = orientation(a, b, c, to);
  if (!(side_from * side_to < 0)) return false;
  const double ab = orientation(a, b, from, to), bc = orientation(b, c, from, to),
               ca = orientation(c, a, from, to);
  return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
}

/// Whether an edge of the first triangle passes through the second, shared corners aside.
bool cuts(const TriangleSurface& surface, std::size_t first, std::size_t second) {
  const auto& other = surface.triangles[second];
  const auto is_shared = [&](std::int32_t p) { return std::ranges::find(other, p) != other.end(); };
  for (std::size_t k = 0; k < 3; ++k) {
    const auto from = surface.triangles[first][k], to = surface.triangles[first][(k + 1) % 3];
    if (is_shared(from) || is_shared(to)) continue;
    if (pierces(surface.points[static_cast<std::size_t>(from)], surface.points[static_cast<std::size_t>(to)],
                point(surface, second, 0), point(surface, second, 1), point(surface, second, 2)))
      return true;
  }
  return false;
}

}  // namespace

void require_closed(TriangleSurface& surface, const std::string& name) {
  if (surface.triangles.empty()) throw UserError(name + ": has no triangle");
  require_areas(surface, name);
  require_closed_edges(surface, name);
  const double volume = signed_volume(surface);
  if (volume == 0) throw UserError(name + ": encloses no volume");
  if (volume < 0)
    for (auto& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  TriangleTree(surface).for_each_close_pair([&](std::size_t first, std::size_t second) {
    if (cuts(surface, first, second) || cuts(surface, second, first))
      throw UserError(name + formatted(": triangles %zu and %zu, at ", first + 1, second + 1) +
                      shown(point(surface, first, 0)) +
                      ", cut each other: the surface must not intersect itself");
  });
}

}  // namespace evert
