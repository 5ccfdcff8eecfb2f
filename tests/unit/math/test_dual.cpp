#include "evert/math/dual.hpp"
#include "evert/math/vec3.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evert {
namespace {

using D = Dual<double>;

/// d/dx at x of a function of one number.
template <class Function>
double slope(Function f, double x) {
  return f(D{x, 1}).derivative;
}

TEST(Dual, FollowsTheRulesOfDifferentiation) {
  const double x = 1.7;
  EXPECT_DOUBLE_EQ(slope([](D t) { return t * t - 3.0 * t + 1.0; }, x), 2 * x - 3);
  EXPECT_DOUBLE_EQ(slope([](D t) { return 1.0 / (t * t); }, x), -2 / (x * x * x));
  EXPECT_DOUBLE_EQ(slope([](D t) { return sqrt(t); }, x), 0.5 / std::sqrt(x));
  EXPECT_DOUBLE_EQ(slope([](D t) { return t * log(t); }, x), std::log(x) + 1);
  EXPECT_DOUBLE_EQ(slope([](D t) { return exp(t * t); }, x), 2 * x * std::exp(x * x));
  EXPECT_DOUBLE_EQ(slope([](D t) { return -t; }, x), -1);
  EXPECT_DOUBLE_EQ(slope([](D t) { return abs(t); }, -x), -1);
  EXPECT_DOUBLE_EQ(slope([](D t) { return multiply_sign(t * t, t); }, -x), 2 * x);
  EXPECT_DOUBLE_EQ(slope([](D t) { return copysign(t, D(-1.0)); }, x), -1);
}

TEST(Dual, AccumulatesInPlace) {
  EXPECT_DOUBLE_EQ(slope(
                       [](D t) {
                         D sum = t;
                         sum += t;
                         sum *= t;
                         sum -= t;
                         sum /= t;
                         return sum;  // 2t − 1
                       },
                       0.3),
                   2);
}

TEST(Dual, SelectsTheBranchOfTheValue) {
  const auto limited = [](D t) { return max(min(t * t, D(4.0)), D(1.0)); };
  EXPECT_EQ(slope(limited, 0.5), 0);
  EXPECT_EQ(slope(limited, 1.5), 3);
  EXPECT_EQ(slope(limited, 2.5), 0);
  EXPECT_TRUE(D(1.0) < D(2.0) && D(1.0) <= D(1.0) && D(2.0) > D(1.0) && D(2.0) >= D(2.0));
}

TEST(Dual, RunsMatrixKernels) {
  // d det(A) = det(A) tr(A⁻¹ dA)
  const Mat3d a{{{{2, 0.5, 0}, {-0.3, 1, 0.7}, {0.1, 0, 3}}}}, da{{{{1, 2, -1}, {0.5, 0, 1}, {2, 1, 1}}}};
  Mat3<D> dual;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) dual(i, j) = D{a(i, j), da(i, j)};
  }
  EXPECT_NEAR(determinant(dual).derivative, determinant(a) * trace(inverse(a) * da), 1e-14);
}

}  // namespace
}  // namespace evert
