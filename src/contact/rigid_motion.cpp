#include "evert/contact/rigid_motion.hpp"

#include "evert/math/quaternion.hpp"

#include <cmath>
#include <numbers>

namespace evert {

RigidState UniformMotion::at(double t) const {
  const auto velocity = start_.velocity_at(about_);
  return displaced(
      start_, about_,
      {rotation_by(t * start_.angular_velocity), t * velocity, velocity, start_.angular_velocity});
}

RigidState Oscillation::at(double t) const {
  const double rate = 2 * std::numbers::pi * frequency_, angle = rate * t + phase_;
  const double now = std::sin(angle), change = rate * std::cos(angle);
  return displaced(start_, about_,
                   {rotation_by(now * angle_), now * amplitude_, change * amplitude_, change * angle_});
}

Mat3d rotation_by(const Vec3d& v) { return rotation_matrix(quaternion_by(v)); }

RigidState displaced(const RigidState& start, const Vec3d& about, const RigidState& displacement) {
  const auto arm = displacement.rotation * (start.origin - about);
  return {displacement.rotation * start.rotation, about + displacement.origin + arm,
          displacement.velocity + cross(displacement.angular_velocity, arm), displacement.angular_velocity};
}

}  // namespace evert
