#pragma once
#include "evert/core/index.hpp"
#include "evert/math/vec3.hpp"

#include <span>
#include <vector>

/// Velocities that the implicit solve must not change: those of fixed and scripted nodes, and the normal ones
/// of colliding nodes.  PHYSICS 5
namespace evert {

/// One constrained owned node: v = free · v + prescribed, with free an orthogonal projector and
/// free·prescribed = 0.
struct NodeConstraint {
  LocalIndex node = 0;
  Mat3d free{};        ///< P: identity less the constrained directions
  Vec3d prescribed{};  ///< [m/s], in the constrained directions only
};

/// The orthogonal projector onto what is perpendicular to all `directions` (unit or zero, need not be
/// independent).
[[nodiscard]] Mat3d projector_off(std::span<const Vec3d> directions);

/// P·v at every constrained node of `values` (x y z per node).
void project(std::span<const NodeConstraint> constraints, std::span<double> values);

/// P·v + prescribed at every constrained node.
void impose(std::span<const NodeConstraint> constraints, std::span<double> values);

/// Joins two lists sorted by node into one; a node in both keeps the directions of both, those of `first`
/// winning where they disagree. Writes to `joined` without allocating when its capacity suffices.
void join(std::span<const NodeConstraint> first, std::span<const NodeConstraint> second,
          std::vector<NodeConstraint>& joined);

}  // namespace evert
