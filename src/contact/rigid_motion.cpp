#include "evert/contact/rigid_motion.hpp"

#include <cmath>

namespace evert {

RigidState UniformMotion::at(double t) const {
  auto state = start_;
  state.origin += t * start_.velocity;
  if (start_.angular_velocity != Vec3d{})
    state.rotation = rotation_by(t * start_.angular_velocity) * start_.rotation;
  return state;
}

/// Rodrigues' formula, with sin(θ)/θ and (1 − cos θ)/θ² as they are at small angles.
Mat3d rotation_by(const Vec3d& v) {
  const double angle = norm(v), half = angle / 2;
  const double sine = angle > 0 ? std::sin(angle) / angle : 1;
  const double versine = half > 0 ? std::pow(std::sin(half) / half, 2) / 2 : 0.5;
  const Mat3d crossing{{{{0, v[2], -v[1]}, {-v[2], 0, v[0]}, {v[1], -v[0], 0}}}};
  return identity<double>() + sine * crossing + versine * (crossing * crossing);
}

}  // namespace evert
