#pragma once
#include "evert/math/vec3.hpp"

#include <random>
#include <span>
#include <string_view>

namespace evert::test {

using Random = std::mt19937_64;

/// A family of matrices that is awkward in one way.
struct Family {
  std::string_view name;
  Mat3d (*sample)(Random&);
};

/// Random, near-degenerate, inverted, rank-deficient, repeated, graded and scaled matrices, and those whose
/// entries come from small awkward sets.
std::span<const Family> families();

}  // namespace evert::test
