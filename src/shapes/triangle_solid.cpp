#include "evert/shapes/triangle_solid.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace evert {
namespace {

constexpr double band_share = 1.0 / 64;  // of the longest side of the box

Vec3d unit(const Vec3d& v) { return (1 / norm(v)) * v; }

}  // namespace

TriangleSolid::TriangleSolid(TriangleSurface surface) : tree_(std::move(surface)) {
  set_normals();
  const auto size = bounds().upper - bounds().lower;
  band_ = band_share * std::max({size[0], size[1], size[2]});
  narrow_band_ = make_narrow_band(tree_.surface(), band_);
}

void TriangleSolid::set_normals() {
  const auto& surface = tree_.surface();
  const auto corner = [&](std::size_t t, std::size_t k) { return tree_.corner(t, k); };
  const auto count = surface.triangles.size();
  face_normals_.resize(count);
  edge_normals_.resize(count);
  corner_normals_.assign(surface.points.size(), Vec3d{});
  struct EdgeUse {
    std::int32_t low, high;
    std::size_t triangle, edge;
  };
  std::vector<EdgeUse> uses;
  uses.reserve(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    face_normals_[t] = unit(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto u = unit(corner(t, (k + 1) % 3) - corner(t, k));
      const auto v = unit(corner(t, (k + 2) % 3) - corner(t, k));
      const double angle = std::atan2(norm(cross(u, v)), dot(u, v));
      const auto a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      corner_normals_[static_cast<std::size_t>(a)] += angle * face_normals_[t];
      uses.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  }
  for (auto& normal : corner_normals_) {
    const double length = norm(normal);
    normal = length > 0 ? (1 / length) * normal : Vec3d{0, 1, 0};
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  for (std::size_t i = 0; i + 1 < uses.size(); i += 2) {
    const auto sum = face_normals_[uses[i].triangle] + face_normals_[uses[i + 1].triangle];
    for (const auto& use : {uses[i], uses[i + 1]})
      edge_normals_[use.triangle][use.edge] = norm(sum) > 0 ? unit(sum) : face_normals_[use.triangle];
  }
}

const Vec3d& TriangleSolid::normal_of(const NearestPart& found) const {
  if (found.corner >= 0)
    return corner_normals_[static_cast<std::size_t>(
        tree_.surface().triangles[found.triangle][static_cast<std::size_t>(found.corner)])];
  if (found.edge >= 0) return edge_normals_[found.triangle][static_cast<std::size_t>(found.edge)];
  return face_normals_[found.triangle];
}

double TriangleSolid::signed_distance(const Vec3d& x) const {
  if (squared_distance(bounds(), x) >= band_ * band_) return band_;
  if (narrow_band_ && narrow_band_->is_far_outside(x)) return band_;
  const auto found = tree_.nearest(x);
  const double distance = std::sqrt(found.squared);
  return dot(x - found.point, normal_of(found)) < 0 ? -distance : std::min(distance, band_);
}

Vec3d TriangleSolid::normal(const Vec3d& x) const {
  const auto found = tree_.nearest(x);
  const auto& outward = normal_of(found);
  const double distance = std::sqrt(found.squared);
  const bool is_on_face = found.edge < 0 && found.corner < 0;
  const auto size = bounds().upper - bounds().lower;
  // so near to an edge the way there says nothing about its direction
  if (is_on_face || distance <= 1e-9 * norm(size)) return outward;
  const double sign = dot(x - found.point, outward) < 0 ? -1 : 1;
  return (sign / distance) * (x - found.point);
}

}  // namespace evert
