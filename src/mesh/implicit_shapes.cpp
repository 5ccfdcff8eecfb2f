#include "evert/mesh/implicit_shapes.hpp"

#include "positive.hpp"
#include <algorithm>
#include <cmath>

namespace evert {
namespace {

double norm(const Vec3d& a) { return std::hypot(a[0], a[1], a[2]); }

}  // namespace

ImplicitShape ball(double radius) {
  require_positive(radius, "radius");
  return {"ball",
          [=](const Vec3d& p) { return norm(p) - radius; },
          {-radius, -radius, -radius},
          {radius, radius, radius}};
}

ImplicitShape torus(double major_radius, double minor_radius) {
  require_positive(major_radius, "major_radius");
  require_positive(minor_radius, "minor_radius");
  if (minor_radius >= major_radius)
    throw UserError("minor_radius is " + shortest(minor_radius) + ", but must be less than major_radius, " +
                    shortest(major_radius));
  const double reach = major_radius + minor_radius;
  return {
      "torus",
      [=](const Vec3d& p) { return std::hypot(std::hypot(p[0], p[2]) - major_radius, p[1]) - minor_radius; },
      {-reach, -minor_radius, -reach},
      {reach, minor_radius, reach}};
}

ImplicitShape cylinder(double radius, double length) {
  require_positive(radius, "radius");
  require_positive(length, "length");
  return {
      "cylinder",
      [=](const Vec3d& p) { return std::max(std::hypot(p[0], p[2]) - radius, std::abs(p[1]) - length / 2); },
      {-radius, -length / 2, -radius},
      {radius, length / 2, radius}};
}

ImplicitShape ellipsoid(const Vec3d& radii) {
  for (const double radius : radii.components) require_positive(radius, "radii");
  return {"ellipsoid",
          [=](const Vec3d& p) {
            return norm({p[0] / radii[0], p[1] / radii[1], p[2] / radii[2]}) - 1;
          },
          -radii, radii};
}

ImplicitShape capsule(double radius, double length) {
  require_positive(radius, "radius");
  require_positive(length, "length");
  return {"capsule",
          [=](const Vec3d& p) {
            const double beyond = std::max(std::abs(p[1]) - length / 2, 0.0);
            return std::hypot(p[0], beyond, p[2]) - radius;
          },
          {-radius, -length / 2 - radius, -radius},
          {radius, length / 2 + radius, radius}};
}

}  // namespace evert
