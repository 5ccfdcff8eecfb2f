#pragma once
#include "evert/math/vec3.hpp"

/// Unit quaternions as rotations: what tables and checkpoints hold, and what rounding cannot shear.
namespace evert {

struct Quaternion {
  double w = 1;
  Vec3d v{};  ///< x, y, z
  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

[[nodiscard]] inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}
/// The inverse of a unit quaternion.
[[nodiscard]] inline Quaternion conjugate(const Quaternion& q) { return {q.w, -q.v}; }
[[nodiscard]] inline double norm(const Quaternion& q) { return std::sqrt(q.w * q.w + dot(q.v, q.v)); }
/// `q` must not be zero.
[[nodiscard]] Quaternion normalized(const Quaternion& q);

/// The rotation by the angle |v| about the direction v, by the right-hand rule.
[[nodiscard]] Quaternion quaternion_by(const Vec3d& v);
/// The v of quaternion_by() for the unit quaternion `q`, the shorter way round: |v| ≤ π.
[[nodiscard]] Vec3d rotation_vector(const Quaternion& q);

/// Of a unit quaternion.
[[nodiscard]] Mat3d rotation_matrix(const Quaternion& q);
/// Of a rotation. S. W. Shepperd, Quaternion from rotation matrix, 1978
[[nodiscard]] Quaternion quaternion_of(const Mat3d& rotation);

}  // namespace evert
