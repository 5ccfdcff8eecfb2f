#pragma once
#include "evert/contact/rigid_motion.hpp"
#include "evert/math/quaternion.hpp"

#include <vector>

namespace evert {

/// A displacement at a time.
struct PoseKey {
  double time = 0;        ///< [s]
  Vec3d position{};       ///< translation [m]
  Quaternion rotation{};  ///< unit
};

/// The place `start`, displaced and turned about the point `about` as a table says: exactly so at its times,
/// with continuous velocities in between, at rest before the first and after the last. Whoever holds still
/// from one key to the next holds still in between, and no component of the translation overshoots its keys.
/// From key to key the rotation goes the shorter way.
///
/// Translations are cubic, with the slopes of Fritsch and Butland, A method for constructing local monotone
/// piecewise cubic interpolants, 1984. Rotations are q exp(φ(t)) from each key q on, φ cubic from 0 to the
/// next key, with the angular velocity that the same slopes give at both.
class KeyframedMotion final : public RigidMotion {
 public:
  /// `keys`: not empty, times increasing, unit quaternions.
  KeyframedMotion(const RigidState& start, const Vec3d& about, std::vector<PoseKey> keys);
  [[nodiscard]] RigidState at(double t) const override;

 private:
  /// From a key to the next. Cubics in the time since the first key, φ(t) = ((c t + b) t + a) t.
  struct Cubic {
    Vec3d a{}, b{}, c{};
    [[nodiscard]] Vec3d at(double t) const { return t * (a + t * (b + t * c)); }
    [[nodiscard]] Vec3d rate(double t) const { return a + t * (2 * b + (3 * t) * c); }
  };
  struct Segment {
    Cubic translation, rotation;
  };
  static Cubic cubic(const Vec3d& way, const Vec3d& rate_at_begin, const Vec3d& rate_at_end, double duration);

  RigidState start_;
  Vec3d about_;
  std::vector<PoseKey> keys_;
  std::vector<Segment> segments_;  // one less than keys
};

}  // namespace evert
