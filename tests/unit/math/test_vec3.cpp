#include "evert/math/pack.hpp"
#include "evert/math/vec3.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evert {
namespace {

constexpr Vec3d a{1, 2, 3}, b{-4, 5, 0.5};
constexpr Mat3d m{{{{2, 0, 1}, {-1, 3, 0}, {4, 1, -2}}}};  // columns
constexpr Mat3d n{{{{1, 1, 0}, {0, 2, 5}, {-3, 0, 1}}}};
constexpr Mat3d unit = identity<double>();

TEST(Vec3, Arithmetic) {
  EXPECT_EQ(a + b, (Vec3d{-3, 7, 3.5}));
  EXPECT_EQ(a - b, (Vec3d{5, -3, 2.5}));
  EXPECT_EQ(-a, (Vec3d{-1, -2, -3}));
  EXPECT_EQ(2 * a, (Vec3d{2, 4, 6}));
  EXPECT_EQ(a * 2, 2 * a);
  Vec3d c = a;
  c += b;
  c -= a;
  EXPECT_EQ(c, b);
  EXPECT_EQ(dot(a, b), 7.5);
  EXPECT_EQ(cross(a, b), (Vec3d{-14, -12.5, 13}));
  EXPECT_EQ(norm(Vec3d{3, 4, 12}), 13);
}

TEST(Mat3, IsStoredByColumns) {
  EXPECT_EQ(m(0, 2), 4);
  EXPECT_EQ(m(2, 0), 1);
  EXPECT_EQ(m.column[1][0], m(0, 1));
}

TEST(Mat3, Products) {
  EXPECT_EQ(m * a, (Vec3d{12, 9, -5}));
  EXPECT_EQ(m * n, (Mat3d{{{{1, 3, 1}, {18, 11, -10}, {-2, 1, -5}}}}));
  EXPECT_EQ(transpose(m)(0, 2), m(2, 0));
  EXPECT_EQ(transpose_times(m, a), transpose(m) * a);
  EXPECT_EQ(transpose_times(m, n), transpose(m) * n);
  EXPECT_EQ(times_transpose(m, n), m * transpose(n));
  EXPECT_EQ(outer(a, b) * Vec3d({1, 0, 0}), -4 * a);
  EXPECT_EQ(m * unit, m);
  EXPECT_EQ(diagonal(a) * b, (Vec3d{-4, 10, 1.5}));
}

TEST(Mat3, Arithmetic) {
  EXPECT_EQ(m + n - n, m);
  EXPECT_EQ(-m, -1 * m);
  EXPECT_EQ(m * 2, m + m);
  Mat3d sum = m;
  sum += n;
  sum -= m;
  EXPECT_EQ(sum, n);
}

TEST(Mat3, Invariants) {
  EXPECT_EQ(trace(m), 3);
  EXPECT_EQ(contract(m, n), 2 + 6 - 14);
  EXPECT_EQ(norm(m), std::sqrt(36.0));
  EXPECT_EQ(determinant(m), -25);
  EXPECT_EQ(determinant(transpose(m)), -25);
  EXPECT_EQ(determinant(unit), 1);
}

TEST(Mat3, CofactorAndInverse) {
  EXPECT_EQ(transpose_times(cofactor(m), m), determinant(m) * unit);
  const Mat3d product = m * inverse(m);
  EXPECT_LT(norm(product - unit), 1e-15);
  EXPECT_EQ(cofactor(Mat3d{}), Mat3d{});
  EXPECT_FALSE(std::isfinite(inverse(Mat3d{})(0, 0)));
}

TEST(Mat3, PacksGiveTheScalarResultInEveryLane) {
  Mat3<Pack> packed;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) packed(i, j) = Pack(m(i, j));
  }
  const Mat3<Pack> result = inverse(2.0 * packed) + identity<Pack>();
  const Mat3d expected = inverse(2.0 * m) + unit;
  for (std::size_t lane_index = 0; lane_index < lanes_v<Pack>; ++lane_index) {
    EXPECT_EQ(lane(result(1, 2), lane_index), expected(1, 2));
  }
  EXPECT_EQ(lane(norm(packed), 0), norm(m));
}

}  // namespace
}  // namespace evert
