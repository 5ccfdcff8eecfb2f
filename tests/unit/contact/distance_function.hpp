#pragma once
#include "evert/shapes/implicit_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evert::test {

/// φ is a distance everywhere: 1-Lipschitz, its gradient the normal, and a step −φ along it ends on the
/// surface. For anything with signed_distance() and normal().
template <class Solid>
void expect_distance_function(const Solid& solid) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 2);
  const auto random_point = [&] { return Vec3d{normal(random), normal(random), normal(random)}; };
  for (int sample = 0; sample < 1000; ++sample) {
    const auto x = random_point();
    const auto y = random_point();
    const double phi = solid.signed_distance(x);
    EXPECT_LE(std::abs(phi - solid.signed_distance(y)), norm(x - y) * (1 + 1e-14));
    const auto n = solid.normal(x);
    EXPECT_NEAR(norm(n), 1, 1e-14);
    EXPECT_NEAR(solid.signed_distance(x - phi * n), 0, 1e-13);
    constexpr double h = 1e-6;
    EXPECT_NEAR((solid.signed_distance(x + h * n) - solid.signed_distance(x - h * n)) / (2 * h), 1, 1e-8);
  }
}

}  // namespace evert::test
