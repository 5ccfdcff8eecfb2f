#include "evert/shapes/gear.hpp"

#include "evert/core/positive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evert {
namespace {

constexpr double pressure_angle = 20 * std::numbers::pi / 180;
constexpr int segments = 12;  // of a flank

/// By how much an involute has turned away from the radius where it began, when its radius is `r`.
double involute(double r, double base_radius) {
  const double angle = r > base_radius ? std::acos(base_radius / r) : 0;
  return std::tan(angle) - angle;
}

}  // namespace

Gear::Gear(int teeth, double root_radius, double tip_radius, double width)
    : half_tooth_(std::numbers::pi / teeth), root_(root_radius), tip_(tip_radius), half_width_(width / 2) {
  if (teeth < 3) throw UserError(formatted("teeth is %d, but must be at least 3", teeth));
  require_positive(root_radius, "root_radius");
  require_positive(tip_radius, "tip_radius");
  require_positive(width, "width");
  if (!(root_radius < tip_radius))
    throw UserError(
        formatted("tip_radius is %g, but must be more than root_radius, %g", tip_radius, root_radius));
  const double pitch = (root_ + tip_) / 2, base = pitch * std::cos(pressure_angle);
  const double at_pitch = involute(pitch, base);
  // Half the tooth is this wide at the pitch circle, and from a fifth to nine fifths of it elsewhere.
  const double half_thickness = half_tooth_ / 2, most_change = 0.8 * half_thickness;
  const double curving = std::min({1.0, most_change / (involute(tip_, base) - at_pitch),
                                   most_change / (at_pitch - involute(root_, base))});
  for (int k = 0; k <= segments; ++k) {
    const double r = root_ + (tip_ - root_) * k / segments;
    const double angle = half_thickness + curving * (at_pitch - involute(r, base));
    flank_.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
}

Box3 Gear::bounds() const { return {{-tip_, -half_width_, -tip_}, {tip_, half_width_, tip_}}; }

/// `p` lies between the middle of a tooth and that of the gap beside it. Radii rise along the flank, so that
/// one of its segments alone can part inside from outside.
bool Gear::is_inside(const Point& p) const {
  const double r = std::hypot(p.x, p.z);
  if (r <= root_) return true;
  if (r >= tip_) return false;
  std::size_t k = 1;
  while (k + 1 < flank_.size() && std::hypot(flank_[k].x, flank_[k].z) < r) ++k;
  const auto &a = flank_[k - 1], &b = flank_[k];
  return (b.x - a.x) * (p.z - a.z) - (b.z - a.z) * (p.x - a.x) < 0;
}

Gear::FlatDistance Gear::in_half_tooth(const Point& p) const {
  const double r = std::hypot(p.x, p.z), angle = std::atan2(p.z, p.x);
  const double sign = is_inside(p) ? -1 : 1;
  const Point radial = r > 0 ? Point{p.x / r, p.z / r} : Point{1, 0};
  FlatDistance best{HUGE_VAL, radial};
  const auto is_on_arc = [&](double radius, double from, double to) {
    const double distance = std::abs(r - radius);
    if (angle >= from && angle <= to && distance < best.value) best = {distance, radial};
  };
  is_on_arc(tip_, 0, std::atan2(flank_.back().z, flank_.back().x));
  is_on_arc(root_, std::atan2(flank_.front().z, flank_.front().x), half_tooth_ * (1 + 1e-12));
  for (std::size_t k = 1; k < flank_.size(); ++k) {
    const auto &a = flank_[k - 1], &b = flank_[k];
    const double dx = b.x - a.x, dz = b.z - a.z, length = std::hypot(dx, dz);
    const double along = ((p.x - a.x) * dx + (p.z - a.z) * dz) / (length * length);
    const double share = std::clamp(along, 0.0, 1.0);
    const double away_x = p.x - a.x - share * dx, away_z = p.z - a.z - share * dz;
    const double distance = std::hypot(away_x, away_z);
    if (distance >= best.value) continue;
    const bool at_corner = share != along && distance > 0;
    best = {distance, at_corner ? Point{sign * away_x / distance, sign * away_z / distance}
                                : Point{-dz / length, dx / length}};
  }
  best.value *= sign;
  return best;
}

/// Turning by a tooth and mirroring at its middle change nothing, and the nearest point of the surface is in
/// the same half tooth as the point.
Gear::FlatDistance Gear::in_plane(const Point& p) const {
  const double turn = 2 * half_tooth_ * std::round(std::atan2(p.z, p.x) / (2 * half_tooth_));
  const double c = std::cos(turn), s = std::sin(turn);
  const Point tooth{c * p.x + s * p.z, c * p.z - s * p.x};
  auto found = in_half_tooth({tooth.x, std::abs(tooth.z)});
  const double z = std::copysign(1, tooth.z) * found.normal.z;
  found.normal = {c * found.normal.x - s * z, s * found.normal.x + c * z};
  return found;
}

SignedDistance Gear::near(const Vec3d& x) const {
  const auto flat = in_plane({x[0], x[2]});
  const double beyond = std::abs(x[1]) - half_width_, end = std::copysign(1, x[1]);
  if (flat.value <= 0 || beyond <= 0)
    return beyond > flat.value ? SignedDistance{beyond, {0, end, 0}}
                               : SignedDistance{flat.value, {flat.normal.x, 0, flat.normal.z}};
  const double distance = std::hypot(flat.value, beyond), share = flat.value / distance;
  return {distance, {share * flat.normal.x, end * beyond / distance, share * flat.normal.z}};
}

}  // namespace evert
