#include "evert/shapes/combined.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace evert {
namespace {

/// The part with the least φ, or, for `sign` −1, with the greatest.
const ImplicitSurface& extreme(const std::vector<Solid>& parts, double sign, const Vec3d& x) {
  return **std::min_element(parts.begin(), parts.end(), [&](const Solid& a, const Solid& b) {
    return sign * a->signed_distance(x) < sign * b->signed_distance(x);
  });
}

/// φ at the middle of a cell says how far it is to the inside; a cell that cannot hold any is not looked
/// into, any other is cut into eight, down to a thousandth of the box.
bool holds_any(const ImplicitSurface& solid, const Vec3d& middle, const Vec3d& half, int depth) {
  const double phi = solid.signed_distance(middle);
  if (phi < 0) return true;
  if (depth == 0 || phi >= norm(half)) return false;
  for (int octant = 0; octant < 8; ++octant) {
    Vec3d step = 0.5 * half;
    for (std::size_t k = 0; k < 3; ++k)
      if (((octant >> k) & 1) != 0) step[k] = -step[k];
    if (holds_any(solid, middle + step, 0.5 * half, depth - 1)) return true;
  }
  return false;
}

}  // namespace

double Union::signed_distance(const Vec3d& x) const {
  double least = HUGE_VAL;
  for (const auto& part : parts_) least = std::min(least, part->signed_distance(x));
  return least;
}

Vec3d Union::normal(const Vec3d& x) const { return extreme(parts_, 1, x).normal(x); }

Box3 Union::bounds() const {
  Box3 all;
  for (const auto& part : parts_) {
    const auto box = part->bounds();
    if (!(box.lower[0] <= box.upper[0])) continue;
    all.include(box.lower);
    all.include(box.upper);
  }
  return all;
}

double Intersection::signed_distance(const Vec3d& x) const {
  double greatest = -HUGE_VAL;
  for (const auto& part : parts_) greatest = std::max(greatest, part->signed_distance(x));
  return greatest;
}

Vec3d Intersection::normal(const Vec3d& x) const { return extreme(parts_, -1, x).normal(x); }

Box3 Intersection::bounds() const {
  auto common = Box3::everything();
  for (const auto& part : parts_) {
    const auto box = part->bounds();
    for (std::size_t k = 0; k < 3; ++k) {
      common.lower[k] = std::max(common.lower[k], box.lower[k]);
      common.upper[k] = std::min(common.upper[k], box.upper[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (!(common.lower[k] <= common.upper[k])) return {};
  return common;
}

Solid difference(std::vector<Solid> parts) {
  for (std::size_t i = 1; i < parts.size(); ++i) parts[i] = std::make_unique<Complement>(std::move(parts[i]));
  return std::make_unique<Intersection>(std::move(parts));
}

Box3 Offset::bounds() const {
  auto box = solid_->bounds();
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] -= distance_;
    box.upper[k] += distance_;
    if (!(box.lower[k] <= box.upper[k])) return {};
  }
  return box;
}

Box3 Placed::bounds() const { return placed(solid_->bounds(), rotation_, center_); }

std::optional<TriangleSurface> Placed::own_triangles(const Fineness& fineness) const {
  auto own = solid_->own_triangles(fineness);
  if (own)
    for (auto& point : own->points) point = rotation_ * point + center_;
  return own;
}

Box3 placed(const Box3& box, const Mat3d& rotation, const Vec3d& center) {
  const auto middle = 0.5 * (box.lower + box.upper), half = 0.5 * (box.upper - box.lower);
  if (box.lower[0] > box.upper[0]) return box;  // empty
  if (!std::isfinite(norm(half))) return Box3::everything();
  Vec3d reach{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) reach[i] += std::abs(rotation(i, j)) * half[j];
  const auto now = rotation * middle + center;
  return {now - reach, now + reach};
}

void require_not_empty(const ImplicitSurface& solid, const std::string& name) {
  constexpr int depth = 10;
  const auto box = solid.bounds();
  const auto half = 0.5 * (box.upper - box.lower);
  const bool is_empty = !(box.lower[0] <= box.upper[0]);
  if (!is_empty && !std::isfinite(norm(half))) return;
  if (is_empty || !holds_any(solid, 0.5 * (box.lower + box.upper), half, depth))
    throw UserError(name + " is empty: no point is inside");
}

}  // namespace evert
