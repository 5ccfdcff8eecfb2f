#include "evert/shapes/solids.hpp"

#include "evert/core/positive.hpp"

#include <algorithm>
#include <cmath>

namespace evert {
namespace {

constexpr Vec3d up{0, 1, 0};

/// A direction from the y axis to `x`; any where x lies on it.
Vec3d outward(const Vec3d& x) {
  const double r = std::hypot(x[0], x[2]);
  return r > 0 ? Vec3d{x[0] / r, 0, x[2] / r} : Vec3d{1, 0, 0};
}

/// Distance to a point, less `radius`.
SignedDistance around(const Vec3d& from_point, double radius) {
  const double distance = norm(from_point);
  return {distance - radius, distance > 0 ? (1 / distance) * from_point : up};
}

/// Distance to the box whose half sides are `half`: per component how far it is beyond the side.
SignedDistance to_box(const Vec3d& x, const Vec3d& half) {
  Vec3d beyond{}, outside{};
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    beyond[k] = std::abs(x[k]) - half[k];
    outside[k] = std::copysign(std::max(beyond[k], 0.0), x[k]);
    if (beyond[k] > beyond[nearest]) nearest = k;
  }
  if (beyond[nearest] > 0) return around(outside, 0);
  Vec3d normal{};
  normal[nearest] = std::copysign(1, x[nearest]);
  return {beyond[nearest], normal};
}

}  // namespace

std::optional<TriangleSurface> HalfSpace::own_triangles(const Fineness& fineness) const {
  const auto sideways = std::abs(normal_[1]) < 0.9 ? up : Vec3d{1, 0, 0};
  auto u = cross(sideways, normal_);
  u = (fineness.extent / 2 / norm(u)) * u;
  const auto v = cross(normal_, u);
  return TriangleSurface{{point_ - u - v, point_ + u - v, point_ + u + v, point_ - u + v},
                         {{0, 1, 2}, {0, 2, 3}}};
}

Sphere::Sphere(double radius) : radius_(radius) { require_positive(radius, "radius"); }

// --- box

Box::Box(const Vec3d& size, double rounding) : core_(0.5 * size), rounding_(rounding) {
  double shortest = size[0];
  for (const double side : size.components) {
    require_positive(side, "size");
    shortest = std::min(shortest, side);
  }
  if (!(rounding >= 0) || !(rounding < shortest / 2))
    throw UserError(
        formatted("rounding is %g, but must be in [0, %g): less than half the shortest side of the box",
                  rounding, shortest / 2));
  for (auto& side : core_.components) side -= rounding;
}

SignedDistance Box::near(const Vec3d& x) const {
  auto found = to_box(x, core_);
  found.value -= rounding_;
  return found;
}

Box3 Box::bounds() const {
  const auto half = core_ + Vec3d{rounding_, rounding_, rounding_};
  return {-half, half};
}

// --- ellipsoid

Ellipsoid::Ellipsoid(const Vec3d& radii) : radii_(radii) {
  for (const double radius : radii.components) require_positive(radius, "radii");
}

/// The nearest point q satisfies x_i = q_i (1 + t/a_i²), so q_i = a_i² x_i/(a_i² + t), for the largest root t
/// of Σ (a_i x_i/(a_i² + t))² = 1. With u = t/a² + 1, a the smallest radius, the sum is convex and falls from
/// at least 1 at the largest value that makes a single term 1: Newton's method from there rises to the root
/// and cannot pass it. Rounding ends it. D. Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a
/// Hyperellipsoid (2013), has the equation; a point on a plane of symmetry, where that term vanishes, is
/// taken to be 1e-100 radii beside it, which is less than rounding.
SignedDistance Ellipsoid::near(const Vec3d& x) const {
  constexpr int most_steps = 200;
  const double least = std::min({radii_[0], radii_[1], radii_[2]});
  Vec3d scaled{}, weight{}, pole{};
  double u = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double ratio = radii_[k] / least;
    scaled[k] = std::max(std::abs(x[k]) / radii_[k], 1e-100);
    weight[k] = ratio * ratio * scaled[k];
    pole[k] = (ratio - 1) * (ratio + 1);
    u = std::max(u, weight[k] - pole[k]);
  }
  for (int step = 0; step < most_steps; ++step) {
    double excess = -1, slope = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double term = weight[k] / (u + pole[k]);
      excess += term * term;
      slope += 2 * term * term / (u + pole[k]);
    }
    const double next = u + excess / slope;
    if (!(next > u)) break;
    u = next;
  }
  Vec3d nearest{}, normal{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double on_unit_ball = weight[k] / (u + pole[k]);
    nearest[k] = std::copysign(radii_[k] * on_unit_ball, x[k]);
    normal[k] = std::copysign(on_unit_ball * (least / radii_[k]), x[k]);
  }
  normal = (1 / norm(normal)) * normal;
  return {dot(x - nearest, normal), normal};
}

// --- capsule, torus

Capsule::Capsule(double radius, double length) : radius_(radius), half_length_(length / 2) {
  require_positive(radius, "radius");
  require_positive(length, "length");
}

SignedDistance Capsule::near(const Vec3d& x) const {
  const double beyond = x[1] - std::clamp(x[1], -half_length_, half_length_);
  if (x[0] == 0 && beyond == 0 && x[2] == 0) return {-radius_, {1, 0, 0}};
  return around({x[0], beyond, x[2]}, radius_);
}

Box3 Capsule::bounds() const {
  const Vec3d half{radius_, half_length_ + radius_, radius_};
  return {-half, half};
}

Torus::Torus(double major_radius, double minor_radius)
    : major_radius_(major_radius), minor_radius_(minor_radius) {
  require_positive(major_radius, "major_radius");
  require_positive(minor_radius, "minor_radius");
  if (minor_radius >= major_radius)
    throw UserError(
        formatted("minor_radius is %g, but must be less than major_radius, %g", minor_radius, major_radius));
}

SignedDistance Torus::near(const Vec3d& x) const {
  return around(x - major_radius_ * outward(x), minor_radius_);
}

Box3 Torus::bounds() const {
  const double reach = major_radius_ + minor_radius_;
  return {{-reach, -minor_radius_, -reach}, {reach, minor_radius_, reach}};
}

// --- cone

Cone::Cone(double bottom_radius, double top_radius, double length)
    : bottom_(bottom_radius), top_(top_radius), half_length_(length / 2) {
  require_positive(length, "length");
  if (!(bottom_radius >= 0) || !(top_radius >= 0) || !(std::max(bottom_radius, top_radius) > 0) ||
      !std::isfinite(bottom_radius + top_radius))
    throw UserError(
        formatted("bottom_radius is %g and top_radius %g, but must be at least 0, finite, and one "
                  "of them more than 0",
                  bottom_radius, top_radius));
}

/// In the half plane of the axis and the point the cone is the trapezoid between r = 0, y = ±h and the side.
SignedDistance Cone::near(const Vec3d& x) const {
  const auto away = outward(x);
  const double r = std::hypot(x[0], x[2]), y = x[1];
  const double dr = top_ - bottom_, dy = 2 * half_length_, slant = std::hypot(dr, dy);
  const Vec3d side_normal = (dy / slant) * away - (dr / slant) * up;
  // how far the point is beyond each of the three planes; inside the nearest of them counts
  const double beyond_end = std::abs(y) - half_length_;
  const double beyond_side = ((r - bottom_) * dy - (y + half_length_) * dr) / slant;
  const Vec3d end_normal = std::copysign(1, y) * up;
  if (beyond_end <= 0 && beyond_side <= 0)
    return beyond_end > beyond_side ? SignedDistance{beyond_end, end_normal}
                                    : SignedDistance{beyond_side, side_normal};
  const double along = ((r - bottom_) * dr + (y + half_length_) * dy) / (slant * slant);
  if (beyond_side > 0 && along >= 0 && along <= 1) return {beyond_side, side_normal};
  const double end_radius = y > 0 ? top_ : bottom_;
  if (beyond_end > 0 && r <= end_radius) return {beyond_end, end_normal};
  const double rim = along > 0.5 ? top_ : bottom_, rim_y = along > 0.5 ? half_length_ : -half_length_;
  return around((r - rim) * away + (y - rim_y) * up, 0);
}

Box3 Cone::bounds() const {
  const double reach = std::max(bottom_, top_);
  return {{-reach, -half_length_, -reach}, {reach, half_length_, reach}};
}

Cone cylinder(double radius, double length) {
  require_positive(radius, "radius");
  return {radius, radius, length};
}

}  // namespace evert
