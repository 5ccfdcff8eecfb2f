#include "evert/math/quaternion.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace evert {
namespace {

Vec3d random_vector(std::mt19937& random, double size) {
  std::normal_distribution<double> normal;
  const Vec3d v{normal(random), normal(random), normal(random)};
  return (size / norm(v)) * v;
}

TEST(Quaternion, TurnsAsItsMatrixAndComesBack) {
  std::mt19937 random(3);
  for (const double angle : {0.0, 1e-200, 1e-9, 1e-3, 1.0, 3.0, std::numbers::pi - 1e-9}) {
    const auto v = random_vector(random, angle);
    const auto q = quaternion_by(v);
    const auto r = rotation_matrix(q);
    EXPECT_NEAR(norm(q), 1, 1e-15);
    EXPECT_LE(norm(transpose_times(r, r) - identity<double>()), 1e-14);
    EXPECT_LE(norm(rotation_vector(q) - v), 1e-14 * (1 + angle));
    EXPECT_LE(norm(rotation_vector({-q.w, -q.v}) - v), 1e-14 * (1 + angle)) << "−q is the same rotation";
    EXPECT_LE(norm(rotation_matrix(quaternion_of(r)) - r), 1e-14);
    EXPECT_LE(norm(r * v - v), 1e-15 * angle) << "the axis stays";
  }
}

TEST(Quaternion, ComesFromHalfTurnsAboutEveryAxis) {
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3d axis{};
    axis[k] = std::numbers::pi;
    const auto r = rotation_matrix(quaternion_by(axis));
    EXPECT_LE(norm(rotation_matrix(quaternion_of(r)) - r), 1e-15);
  }
}

TEST(Quaternion, ProductsAreRotationsOneAfterTheOther) {
  std::mt19937 random(5);
  for (int i = 0; i < 20; ++i) {
    const auto a = quaternion_by(random_vector(random, 2)), b = quaternion_by(random_vector(random, 3));
    EXPECT_LE(norm(rotation_matrix(a * b) - rotation_matrix(a) * rotation_matrix(b)), 1e-14);
    EXPECT_LE(norm(rotation_vector(conjugate(a) * a)), 1e-15);
  }
}

}  // namespace
}  // namespace evert
