#include "evert/elements/rest_shape.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

namespace evert {

Mat3d rest_jacobian(const ElementView& element, std::size_t q, std::span<const LocalIndex> cell,
                    std::span<const Vec3d> rest_positions) {
  Mat3d jacobian{};
  for (std::size_t a = 0; a < cell.size(); ++a)
    jacobian += outer(rest_positions[static_cast<std::size_t>(cell[a])], element.gradient(q, a));
  return jacobian;
}

Mat3d triangular_frame(const Mat3d& first_vectors) {
  Eigen::Matrix3d columns;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      columns(i, j) = first_vectors(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }
  const Eigen::Matrix3d q = Eigen::HouseholderQR<Eigen::Matrix3d>(columns).householderQ();
  // A reflection would turn elements inside out. The last axis has no part in the first two vectors.
  const double handedness = q.determinant() < 0 ? -1 : 1;
  const auto axis = [&](int j) { return Vec3d{q(0, j), q(1, j), q(2, j)}; };
  return {axis(0), axis(1), handedness * axis(2)};
}

}  // namespace evert
