#pragma once
#include "evert/math/vec3.hpp"

#include <functional>
#include <string>

namespace evert {

/// A body given by a function that is negative inside, positive outside and continuous across the surface; it
/// need not be a distance.
struct ImplicitShape {
  std::string name;  ///< for messages
  std::function<double(const Vec3d&)> value;
  Vec3d lower{};  ///< corners of a box that holds the whole shape [m]
  Vec3d upper{};
};

// All are centred on the origin. Lengths in metres; UserError when one is not positive and finite.

[[nodiscard]] ImplicitShape ball(double radius);
/// Around the y axis, so that it lies flat where y is up. Throws UserError unless minor_radius <
/// major_radius.
[[nodiscard]] ImplicitShape torus(double major_radius, double minor_radius);
/// Around the y axis.
[[nodiscard]] ImplicitShape cylinder(double radius, double length);
[[nodiscard]] ImplicitShape ellipsoid(const Vec3d& radii);
/// A cylinder around the y axis with a half ball at both ends; `length` is that of the cylinder alone.
[[nodiscard]] ImplicitShape capsule(double radius, double length);

}  // namespace evert
