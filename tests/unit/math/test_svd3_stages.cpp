#include "evert/math/svd3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace evert {
namespace {

constexpr double sqrt3 = std::numbers::sqrt3;

Mat3d gaussian(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Mat3d m;
  for (auto& column : m.column) {
    for (double& entry : column.components) entry = normal(random);
  }
  return m;
}

Mat3d of_frame(const Frame<double>& frame) { return {frame.normal, frame.first, frame.second}; }

Deflation<double> deflation_of(const Mat3d& f) { return deflate(f); }

Mat3d rotation(std::mt19937_64& random) { return polar_rotation(deflation_of(gaussian(random))); }

TEST(ScaleToUnit, IsExact) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 1000; ++k) {
    const Mat3d f = std::ldexp(1.0, int(random() % 1000) - 500) * gaussian(random);
    const auto [unit, scale] = scale_to_unit(f);
    EXPECT_EQ(scale * unit, f);
    double largest = 0;
    for (std::size_t c = 0; c < 9; ++c) largest = std::max(largest, std::abs(unit(c % 3, c / 3)));
    EXPECT_GE(largest, 1);
    EXPECT_LT(largest, 2);
  }
}

TEST(ScaleToUnit, TakesTheEndsOfTheRange) {
  EXPECT_EQ(scale_to_unit(Mat3d{}).f, Mat3d{});
  const double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
  const auto of_huge = scale_to_unit(diagonal<double>({huge, 0, -huge}));
  EXPECT_LT(of_huge.f(0, 0), 4);
  EXPECT_EQ(of_huge.f(0, 0) * of_huge.scale, huge);
  const auto of_tiny = scale_to_unit(diagonal<double>({tiny, 0, 0}));
  EXPECT_GT(of_tiny.f(0, 0), 1e-16);
  EXPECT_EQ(of_tiny.f(0, 0) * of_tiny.scale, tiny);
}

TEST(NormalizedSquare, IsTheDeviatorOfTheCauchyGreenTensor) {
  std::mt19937_64 random(2);
  const Mat3d f = gaussian(random);
  const Mat3d s = transpose_times(f, f);
  const Mat3d b = (3 / trace(s)) * s - identity<double>();
  const auto square = normalized_square(f);
  EXPECT_NEAR(square.inverse_mean_square, 3 / trace(s), 1e-15);
  EXPECT_NEAR(square.b00, b(0, 0), 1e-15);
  EXPECT_NEAR(square.b11, b(1, 1), 1e-15);
  EXPECT_NEAR(square.b22, b(2, 2), 1e-15);
  EXPECT_NEAR(square.b01, b(0, 1), 1e-15);
  EXPECT_NEAR(square.b02, b(0, 2), 1e-15);
  EXPECT_NEAR(square.b12, b(1, 2), 1e-15);
  EXPECT_NEAR(square.spread, contract(b, b) / 6, 1e-15);
  EXPECT_NEAR(square.half_determinant, determinant(b) / 2, 1e-15);
}

TEST(NormalizedSquare, IsFiniteForZeroAndForRotations) {
  EXPECT_TRUE(std::isfinite(normalized_square(Mat3d{}).inverse_mean_square));
  const auto square = normalized_square(identity<double>());
  EXPECT_EQ(square.b00, 0);
  EXPECT_GT(square.spread, 0);
}

template <class T>
T worst_cubic_root_error() {
  T worst = 0;
  for (int k = 0; k <= 100000; ++k) {
    const T g = T(k) / 100000;
    worst = std::max(worst, std::abs(largest_cubic_root(g) - 2 * std::cos(std::acos(g) / 3)));
  }
  return worst;
}

TEST(LargestCubicRoot, IsAccurateToRounding) {
  EXPECT_LE(worst_cubic_root_error<float>(), 5e-7F);
  EXPECT_LE(worst_cubic_root_error<double>(), 1.2e-15);
  EXPECT_LE(worst_cubic_root_error<long double>(), 6e-19L);
}

TEST(IsolatedRoot, BelongsToTheBestSeparatedStretch) {
  const auto root_of = [](const Vec3d& sigma) {
    return isolated_root(normalized_square(diagonal(sigma))).root;
  };
  EXPECT_NEAR(root_of({3, 1, 1}), 2, 1e-15);   // σ1 alone
  EXPECT_NEAR(root_of({3, 3, 1}), -2, 1e-15);  // σ3 alone
  EXPECT_NEAR(std::abs(root_of({std::sqrt(3.0), std::sqrt(2.0), 1})), sqrt3, 1e-14);
  EXPECT_NEAR(std::abs(root_of({1, 1, 1})), sqrt3, 1e-7);
  EXPECT_NEAR(root_of({1, 0, 0}), 2, 1e-15);
}

TEST(IsolatedRoot, IsAnEigenvalueOfTheNormalizedSquare) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 1000; ++k) {
    const auto b = normalized_square(gaussian(random));
    const auto isolated = isolated_root(b);
    const double eigenvalue = isolated.root / isolated.inverse_spread;
    const Mat3d shifted{{{{b.b00 - eigenvalue, b.b01, b.b02},
                          {b.b01, b.b11 - eigenvalue, b.b12},
                          {b.b02, b.b12, b.b22 - eigenvalue}}}};
    EXPECT_NEAR(determinant(shifted), 0, 1e-14);
  }
}

TEST(IsolatedDirection, IsTheRightSingularVector) {
  std::mt19937_64 random(4);
  for (const Vec3d& sigma :
       {Vec3d{5, 1, 0.5}, Vec3d{5, 4, 0.1}, Vec3d{5, 4, -0.1}, Vec3d{2, 0, 0}, Vec3d{2, 2, 0}}) {
    for (int k = 0; k < 500; ++k) {
      const Mat3d v = rotation(random);
      const Mat3d f = times_transpose(rotation(random) * diagonal(sigma), v);
      const auto square = normalized_square(f);
      const auto isolated = isolated_root(square);
      const Vec3d w = isolated_direction(square, isolated);
      const Vec3d expected = v.column[isolated.root > 0 ? 0 : 2];
      EXPECT_LE(norm(cross(w, expected)), 3e-15 * norm(w));
    }
  }
}

TEST(FrameAlong, IsRightHandedAndOrthonormal) {
  std::mt19937_64 random(5);
  std::vector<Vec3d> directions{{1, 0, 0},      {0, 1, 0},      {0, 0, 1},      {0, 0, -1},
                                {0, -1, 0},     {-1, 0, -0.0},  {1, 0, -0.0},   {1e-9, 0, -1},
                                {0, 1e-200, 1}, {1, 1, 1e-200}, {1, -1, -1e-17}};
  for (int k = 0; k < 2000; ++k) directions.push_back(gaussian(random).column[0]);
  for (const Vec3d& direction : directions) {
    for (const double length : {1.0, 1e-70, 1e70}) {
      const Frame<double> frame = frame_along(length * direction);
      const Mat3d q = of_frame(frame);
      EXPECT_LE(norm(transpose_times(q, q) - identity<double>()), 2e-15);
      EXPECT_LE(norm(cross(frame.first, frame.second) - frame.normal), 2e-15);
      EXPECT_GT(dot(frame.normal, direction), 0);
      EXPECT_LE(norm(cross(frame.normal, direction)), 1e-15 * norm(direction));
    }
  }
}

TEST(LeftDirection, FollowsTheImageOfTheLargest) {
  const Mat3d f = diagonal<double>({-1, 5, 1});
  const auto square = normalized_square(f);
  const auto isolated = isolated_root(square);
  const auto right = frame_along(isolated_direction(square, isolated));
  const Vec3d l = left_direction(images(f, right), right, square, isolated);
  EXPECT_NEAR(std::abs(l[1]) / norm(l), 1, 1e-15);
  EXPECT_GT(dot(l, f * right.normal), 0);
}

TEST(LeftDirection, IsNormalToTheImageOfThePlaneWhenTheSmallestVanishes) {
  const Mat3d f = diagonal<double>({4, 0, 5});
  const auto square = normalized_square(f);
  const auto isolated = isolated_root(square);
  ASSERT_LT(isolated.root, 0);
  const auto right = frame_along(isolated_direction(square, isolated));
  const Vec3d l = left_direction(images(f, right), right, square, isolated);
  EXPECT_NEAR(std::abs(l[1]) / norm(l), 1, 1e-15);
}

TEST(LeftDirection, OfZeroIsTheRightOne) {
  const Mat3d f{};
  const auto square = normalized_square(f);
  const auto isolated = isolated_root(square);
  const auto right = frame_along(isolated_direction(square, isolated));
  EXPECT_EQ(left_direction(images(f, right), right, square, isolated), right.normal);
}

TEST(PlaneRemainder, HoldsTheRestOfTheMatrix) {
  std::mt19937_64 random(6);
  for (int k = 0; k < 1000; ++k) {
    const Mat3d f = gaussian(random);
    const Deflation<double> d = deflation_of(f);
    const Mat3d middle = transpose_times(of_frame(d.left), f * of_frame(d.right));  // block diagonal
    const double size = norm(f);
    for (const std::size_t i : {1U, 2U}) {
      EXPECT_NEAR(middle(0, i), 0, 2e-15 * size);
      EXPECT_NEAR(middle(i, 0), 0, 2e-15 * size);
    }
    const auto& p = d.plane;
    EXPECT_NEAR(d.scale * p.isolated_stretch, middle(0, 0), 2e-15 * size);
    EXPECT_NEAR(d.scale * (p.rotation.x + p.reflection.x), middle(1, 1), 2e-15 * size);
    EXPECT_NEAR(d.scale * (p.rotation.x - p.reflection.x), middle(2, 2), 2e-15 * size);
    EXPECT_NEAR(d.scale * (p.reflection.y - p.rotation.y), middle(1, 2), 2e-15 * size);
    EXPECT_NEAR(d.scale * (p.reflection.y + p.rotation.y), middle(2, 1), 2e-15 * size);
    EXPECT_DOUBLE_EQ(p.rotation.length, std::hypot(p.rotation.x, p.rotation.y));
    EXPECT_DOUBLE_EQ(p.reflection.length, std::hypot(p.reflection.x, p.reflection.y));
  }
}

TEST(Stages, NeedNoScalingBetween1em70And1e70) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 2000; ++k) {
    Mat3d f = gaussian(random);
    if (k % 2 == 0) f.column[2] = f.column[0] - f.column[1];
    for (const double size : {1e-70, 1e-30, 1e30, 1e70}) {
      const Mat3d sized = size * f;
      const auto square = normalized_square(sized);
      const auto isolated = isolated_root(square);
      const auto right = frame_along(isolated_direction(square, isolated));
      const auto f_right = images(sized, right);
      const auto left = frame_along(left_direction(f_right, right, square, isolated));
      const auto plane = plane_remainder(f_right, left);
      const Mat3d rebuilt = isotropic_tensor(left, plane, right, principal_stretches(plane));
      EXPECT_LE(norm(rebuilt - sized), 4e-15 * norm(sized));
    }
  }
}

PlaneVector<double> plane_vector(double x, double y) { return {x, y, std::sqrt(x * x + y * y)}; }

TEST(UnitDirection, NormalisesOrTakesTheAxis) {
  const auto d = unit_direction(plane_vector(-3, 4));
  EXPECT_DOUBLE_EQ(d.cosine, -0.6);
  EXPECT_DOUBLE_EQ(d.sine, 0.8);
  for (const double nothing : {0.0, -0.0, 1e-170, 1e-300}) {
    EXPECT_EQ(unit_direction(plane_vector(nothing, -nothing)).cosine, 1);
    EXPECT_EQ(unit_direction(plane_vector(nothing, -nothing)).sine, 0);
  }
  EXPECT_NEAR(unit_direction(plane_vector(0, 1e-140)).sine, 1, 1e-15);
}

TEST(HalfAngle, HalvesEveryAngle) {
  for (int k = -3600; k <= 3600; ++k) {
    const double angle = std::numbers::pi * k / 3600;
    for (const double length : {1.0, 1e-140, 1e70}) {
      const auto half = half_angle(plane_vector(length * std::cos(angle), length * std::sin(angle)));
      EXPECT_NEAR(half.cosine, std::cos(angle / 2), 1e-15);
      // ±π are the same direction.
      EXPECT_NEAR(std::abs(half.sine), std::abs(std::sin(angle / 2)), 1e-15);
      if (std::abs(k) < 3600) {
        EXPECT_NEAR(half.sine, std::sin(angle / 2), 1e-15);
      }
    }
  }
  EXPECT_EQ(half_angle(plane_vector(0, 0)).cosine, 1);
  EXPECT_EQ(half_angle(plane_vector(0, 0)).sine, 0);
  EXPECT_EQ(half_angle(plane_vector(-1, 0)).sine, 1);
  EXPECT_EQ(half_angle(plane_vector(-1, -0.0)).sine, -1);
  EXPECT_EQ(half_angle(plane_vector(-1e-200, 0)).cosine, 1);
}

}  // namespace
}  // namespace evert
