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

/// Constant velocities: `start` is the state at t = 0. The point `about`, fixed to the body, goes on in a
/// straight line while the body turns about it.
class UniformMotion final : public RigidMotion {
 public:
  UniformMotion(const RigidState& start, const Vec3d& about) : start_(start), about_(about) {}
  /// About its origin.
  explicit UniformMotion(const RigidState& start) : UniformMotion(start, start.origin) {}
  [[nodiscard]] RigidState at(double t) const override;

 private:
  RigidState start_;
  Vec3d about_;
};

/// To and fro: the place `start` displaced by `amplitude` [m] and turned by the vector `angle` [rad] about
/// the point `about`, which is displaced with it, both times sin(2π `frequency` t + `phase`).
class Oscillation final : public RigidMotion {
 public:
  Oscillation(const RigidState& start, const Vec3d& about, const Vec3d& amplitude, const Vec3d& angle,
              double frequency, double phase)
      : start_(start),
        about_(about),
        amplitude_(amplitude),
        angle_(angle),
        frequency_(frequency),
        phase_(phase) {}
  [[nodiscard]] RigidState at(double t) const override;

 private:
  RigidState start_;
  Vec3d about_, amplitude_, angle_;
  double frequency_, phase_;  // [Hz], [rad]
};

/// The rotation by the angle |v| about the direction v, by the right-hand rule.
[[nodiscard]] Mat3d rotation_by(const Vec3d& v);

/// The place `start` after a rotation about the point `about` and a translation: those of `displacement`, as
/// its rotation and origin, whose velocities are the rates of both.
[[nodiscard]] RigidState displaced(const RigidState& start, const Vec3d& about,
                                   const RigidState& displacement);

}  // namespace evert
