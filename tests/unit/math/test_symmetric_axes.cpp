// Principal values and axes of symmetric tensors, against those of Eigen.
#include "evert/math/eigen_symmetric3.hpp"
#include "evert/math/symmetric_axes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace evert {
namespace {

constexpr double negligible = 1e-30;  // of deviators, as deviator() says

struct Tensor {
  std::string name;
  Mat3d e;
};

Mat3d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Mat3d m;
  for (auto& column : m.column)
    for (double& entry : column.components) entry = normal(random);
  return eigen_symmetric3(m + transpose(m)).vectors;
}

/// Of all kinds of repeated values, signs and sizes, turned in many ways.
std::vector<Tensor> tensors() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<Tensor> all{{"zero", Mat3d{}}, {"identity", identity<double>()}};
  const std::vector<Vec3d> values{{1, 1, 2},      {2, 2, 1},        {-1, -1, 2}, {1, 0, 0},
                                  {-3, 0, 0},     {1, 1 + 1e-9, 1}, {1, -1, 0},  {-1, -2, -3},
                                  {1, 1e-12, -1}, {5, 5, 5},        {-5, -5, -5}};
  for (int turn = 0; turn < 200; ++turn) {
    const Mat3d axes = random_rotation(random);
    auto some = values;
    some.push_back({uniform(random), uniform(random), uniform(random)});
    for (const Vec3d& of : some)
      for (const double scale : {1.0, 1e-12, 1e-25, 1e20})
        all.push_back({std::to_string(of[0]) + " " + std::to_string(of[1]) + " " + std::to_string(of[2]) +
                           " times " + std::to_string(scale),
                       scale * (axes * times_transpose(diagonal(of), axes))});
  }
  return all;
}

TEST(SymmetricAxes, AreThoseOfEigen) {
  for (const auto& [name, e] : tensors()) {
    const auto found = symmetric_axes(e);
    Vec3d values = principal_values(found.plane);
    std::ranges::sort(values.components);
    const Vec3d expected = eigen_symmetric3(e).values;
    EXPECT_LE(norm(values - expected), 4e-15 * norm(e) + negligible) << name;
    const Mat3d again = symmetric_tensor(found.axes, found.plane, principal_values(found.plane));
    EXPECT_LE(norm(again - e), 4e-15 * norm(e) + negligible) << name;
  }
}

TEST(SymmetricAxes, GiveFunctionsOfTheTensor) {
  for (const auto& [name, e] : tensors()) {
    const auto found = symmetric_axes(e);
    const Vec3d s = principal_values(found.plane);
    const Mat3d square =
        symmetric_tensor(found.axes, found.plane, Vec3d{s[0] * s[0], s[1] * s[1], s[2] * s[2]});
    EXPECT_LE(norm(square - e * e), norm(e) * (1e-14 * norm(e) + 4 * negligible)) << name;
  }
}

TEST(SymmetricAxes, HandOnWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto found = symmetric_axes(diagonal<double>({1, nan, 2}));
  EXPECT_TRUE(std::isnan(principal_values(found.plane)[0]));
}

}  // namespace
}  // namespace evert
