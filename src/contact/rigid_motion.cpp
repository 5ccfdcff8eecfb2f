#include "evert/contact/rigid_motion.hpp"

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

/// Rodrigues' formula, with sin(θ)/θ and (1 − cos θ)/θ² as they are at small angles.
Mat3d rotation_by(const Vec3d& v) {
  const double angle = norm(v), half = angle / 2;
  const double sine = angle > 0 ? std::sin(angle) / angle : 1;
  const double versine = half > 0 ? std::pow(std::sin(half) / half, 2) / 2 : 0.5;
  const Mat3d crossing{{{{0, v[2], -v[1]}, {-v[2], 0, v[0]}, {v[1], -v[0], 0}}}};
  return identity<double>() + sine * crossing + versine * (crossing * crossing);
}

RigidState displaced(const RigidState& start, const Vec3d& about, const RigidState& displacement) {
  const auto arm = displacement.rotation * (start.origin - about);
  return {displacement.rotation * start.rotation, about + displacement.origin + arm,
          displacement.velocity + cross(displacement.angular_velocity, arm), displacement.angular_velocity};
}

}  // namespace evert
