#pragma once
#include "evert/math/vec3.hpp"

#include <span>

/// One node's value in an array of x y z per node.
namespace evert {

[[nodiscard]] inline Vec3d node_value(std::span<const double> values, std::ptrdiff_t node) {
  const auto i = 3 * static_cast<std::size_t>(node);
  return {values[i], values[i + 1], values[i + 2]};
}

inline void set_node_value(std::span<double> values, std::ptrdiff_t node, const Vec3d& value) {
  const auto i = 3 * static_cast<std::size_t>(node);
  for (std::size_t k = 0; k < 3; ++k) values[i + k] = value[k];
}

}  // namespace evert
