#pragma once
#include "evert/math/vec3.hpp"

/// How rigid bodies move, independent of their shapes.
namespace evert {

/// Where a rigid body is, and how it moves there.
struct RigidState {
  Mat3d rotation = identity<double>();  ///< from the frame of the body to that of the world
  Vec3d origin{};                       ///< of the frame of the body, in the world [m]
  Vec3d velocity{};                     ///< of that origin [m/s]
  Vec3d angular_velocity{};             ///< in the world [rad/s]

  [[nodiscard]] Vec3d to_world(const Vec3d& local) const { return rotation * local + origin; }
  [[nodiscard]] Vec3d to_body(const Vec3d& x) const { return transpose_times(rotation, x - origin); }
  /// Of the body's material at the place `x` of the world [m/s].
  [[nodiscard]] Vec3d velocity_at(const Vec3d& x) const {
    return velocity + cross(angular_velocity, x - origin);
  }
};

class RigidMotion {
 public:
  virtual ~RigidMotion() = default;
  /// At time `t` [s].
  [[nodiscard]] virtual RigidState at(double t) const = 0;
};

/// Constant velocities: `start` is the state at t = 0, whose origin goes on in a straight line while the body
/// turns about it.
class UniformMotion final : public RigidMotion {
 public:
  explicit UniformMotion(const RigidState& start) : start_(start) {}
  [[nodiscard]] RigidState at(double t) const override;

 private:
  RigidState start_;
};

/// The rotation by the angle |v| about the direction v, by the right-hand rule.
[[nodiscard]] Mat3d rotation_by(const Vec3d& v);

}  // namespace evert
