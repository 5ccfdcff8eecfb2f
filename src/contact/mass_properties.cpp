#include "evert/contact/mass_properties.hpp"

#include "evert/contact/support_points.hpp"
#include "evert/shapes/solids.hpp"

#include <numbers>

namespace evert {
namespace {

constexpr double pi = std::numbers::pi;

/// The inertia tensor of the second moments ∫ x xᵀ.
Mat3d inertia_of(const Mat3d& moments) { return trace(moments) * identity<double>() - moments; }

}  // namespace

MassProperties ball_mass(double radius) {
  const double mass = 4 * pi / 3 * radius * radius * radius;
  return {mass, {}, (0.4 * mass * radius * radius) * identity<double>()};
}

MassProperties box_mass(const Vec3d& size) {
  const double mass = size[0] * size[1] * size[2];
  Vec3d moments{};
  for (std::size_t k = 0; k < 3; ++k) moments[k] = mass * size[k] * size[k] / 12;
  return {mass, {}, inertia_of(diagonal(moments))};
}

MassProperties capsule_mass(double radius, double length) {
  const double square = radius * radius;
  const double cylinder = pi * square * length, ball = 4 * pi / 3 * square * radius;
  const double across = cylinder * square / 4 + ball * square / 5;
  // The halves of the ball lie length / 2 out, their centres of mass 3/8 of the radius further.
  const double along =
      cylinder * length * length / 12 + ball * (square / 5 + length * length / 4 + 0.375 * radius * length);
  return {cylinder + ball, {}, inertia_of(diagonal(Vec3d{across, along, across}))};
}

MassProperties enclosed_mass(const TriangleSurface& surface) {
  const auto& points = surface.points;
  // Signed tetrahedra with one corner at a point near all of them, against cancellation.
  Vec3d near{};
  for (const auto& point : points) near += (1 / static_cast<double>(points.size())) * point;
  double volume = 0;
  Vec3d first{};
  Mat3d second{};
  const auto corner = [&](std::int32_t point) { return points[static_cast<std::size_t>(point)] - near; };
  for (const auto& [i, j, k] : surface.triangles) {
    const auto a = corner(i), b = corner(j), c = corner(k);
    const double part = dot(a, cross(b, c)) / 6;
    const auto sum = a + b + c;
    volume += part;
    first += (part / 4) * sum;
    second += (part / 20) * (outer(a, a) + outer(b, b) + outer(c, c) + outer(sum, sum));
  }
  const auto center = (1 / volume) * first;
  return {volume, near + center, inertia_of(second - volume * outer(center, center))};
}

MassProperties mass_of(const ImplicitSurface& solid) {
  constexpr Fineness fine{.cells = 96};  // volumes within a thousandth
  const auto size = solid.bounds().upper - solid.bounds().lower;
  if (dynamic_cast<const Sphere*>(&solid) != nullptr) return ball_mass(size[0] / 2);
  if (dynamic_cast<const Capsule*>(&solid) != nullptr) return capsule_mass(size[0] / 2, size[1] - size[0]);
  if (is_sharp_box(solid)) return box_mass(size);
  return enclosed_mass(triangulate(solid, fine));
}

}  // namespace evert
