#include "evert/math/quaternion.hpp"

#include <algorithm>

namespace evert {

Quaternion normalized(const Quaternion& q) {
  const double scale = 1 / norm(q);
  return {scale * q.w, scale * q.v};
}

Quaternion quaternion_by(const Vec3d& v) {
  const double half = norm(v) / 2;
  return {std::cos(half), (half > 0 ? std::sin(half) / half / 2 : 0.5) * v};
}

Vec3d rotation_vector(const Quaternion& q) {
  const double sine = norm(q.v), cosine = std::abs(q.w);
  const double sign = q.w < 0 ? -1 : 1;  // q and −q are one rotation
  return (sign * (sine > 0 ? 2 * std::atan2(sine, cosine) / sine : 2)) * q.v;
}

Mat3d rotation_matrix(const Quaternion& q) {
  const auto& [x, y, z] = q.v.components;
  return {{{{1 - 2 * (y * y + z * z), 2 * (x * y + q.w * z), 2 * (x * z - q.w * y)},
            {2 * (x * y - q.w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + q.w * x)},
            {2 * (x * z + q.w * y), 2 * (y * z - q.w * x), 1 - 2 * (x * x + y * y)}}}};
}

Quaternion quaternion_of(const Mat3d& r) {
  // 4 q qᵀ is known but for its signs: the row of the largest entry gives all of them without cancellation.
  const std::array<double, 4> squares{1 + trace(r), 1 + 2 * r(0, 0) - trace(r), 1 + 2 * r(1, 1) - trace(r),
                                      1 + 2 * r(2, 2) - trace(r)};
  const Vec3d skew{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  if (largest == 0) return normalized({squares[0], skew});
  const auto k = static_cast<std::size_t>(largest - 1);
  Quaternion q{skew[k], {}};
  for (std::size_t i = 0; i < 3; ++i) q.v[i] = i == k ? squares[k + 1] : r(i, k) + r(k, i);
  return normalized(q);
}

}  // namespace evert
