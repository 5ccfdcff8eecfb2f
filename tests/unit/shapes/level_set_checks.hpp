#pragma once
#include "evert/shapes/implicit_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace evert::test {

/// A solid, said a second time in the simplest words.
struct Subject {
  std::string name;
  std::shared_ptr<const ImplicitSurface> solid;
  std::function<bool(const Vec3d&)> is_inside;
};

class RandomPoints {
 public:
  explicit RandomPoints(const Box3& box) : box_(box) {}
  Vec3d operator()() {
    Vec3d x{};
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = std::uniform_real_distribution<double>(box_.lower[k], box_.upper[k])(random_);
    return x;
  }

 private:
  std::mt19937_64 random_{7};
  Box3 box_;
};

inline Box3 grown(const Box3& box, double share) {
  const auto more = share * (box.upper - box.lower);
  const double most = std::max({more[0], more[1], more[2]});
  return {box.lower - Vec3d{most, most, most}, box.upper + Vec3d{most, most, most}};
}

/// Points of the surface, found with `is_inside` alone.
inline std::vector<Vec3d> surface_points(const Subject& subject, int count) {
  RandomPoints within(subject.solid->bounds()), around(grown(subject.solid->bounds(), 0.3));
  std::vector<Vec3d> points;
  while (points.size() < static_cast<std::size_t>(count)) {
    auto in = within(), out = around();
    if (!subject.is_inside(in) || subject.is_inside(out)) continue;
    for (int n = 0; n < 60; ++n) {
      const auto middle = 0.5 * (in + out);
      (subject.is_inside(middle) ? in : out) = middle;
    }
    points.push_back(in);
  }
  return points;
}

inline double brute_force_distance(const std::vector<Vec3d>& points, const Vec3d& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& point : points) least = std::min(least, norm(point - x));
  return least;
}

/// What holds for every solid: the sign, the bounds, Lipschitz, no point of the surface nearer than |φ|, the
/// normal being the gradient; and near the surface, a way −φ along the normal ends on it.
inline void expect_level_set(const Subject& subject) {
  SCOPED_TRACE(subject.name);
  const auto& solid = *subject.solid;
  const auto size = solid.bounds().upper - solid.bounds().lower;
  const double scale = std::max({size[0], size[1], size[2]});
  const auto points = surface_points(subject, 3000);
  RandomPoints random(grown(solid.bounds(), 0.3));
  int kinks = 0;
  constexpr int samples = 1500;
  for (int n = 0; n < samples; ++n) {
    const auto x = random(), y = random();
    const double phi = solid.signed_distance(x);
    ASSERT_EQ(phi < 0, subject.is_inside(x)) << phi;
    ASSERT_TRUE(phi >= 0 || solid.bounds().contains(x));
    ASSERT_LE(std::abs(phi - solid.signed_distance(y)), norm(x - y) * (1 + 1e-12));
    ASSERT_LE(std::abs(phi), brute_force_distance(points, x) * (1 + 1e-12) + 1e-13 * scale);
    const auto normal = solid.normal(x);
    ASSERT_NEAR(norm(normal), 1, 1e-12);
    const double h = 1e-6 * scale;
    const double slope =
        (solid.signed_distance(x + h * normal) - solid.signed_distance(x - h * normal)) / (2 * h);
    kinks += std::abs(slope - 1) > 1e-6 ? 1 : 0;
  }
  // a random point hits the h-neighbourhood of the medial surface seldom
  EXPECT_LE(kinks, samples / 100);
  for (const auto& on_surface : points) EXPECT_NEAR(solid.signed_distance(on_surface), 0, 1e-12 * scale);
}

/// φ is the distance, everywhere: besides the above, a way −φ along the normal ends on the surface.
inline void expect_exact(const Subject& subject) {
  expect_level_set(subject);
  SCOPED_TRACE(subject.name);
  const auto& solid = *subject.solid;
  const auto size = solid.bounds().upper - solid.bounds().lower;
  const double scale = std::max({size[0], size[1], size[2]});
  RandomPoints random(grown(solid.bounds(), 0.3));
  for (int n = 0; n < 5000; ++n) {
    const auto x = random();
    const auto foot = x - solid.signed_distance(x) * solid.normal(x);
    ASSERT_NEAR(solid.signed_distance(foot), 0, 1e-12 * scale) << x[0] << ' ' << x[1] << ' ' << x[2];
  }
}

}  // namespace evert::test
