#pragma once
#include "evert/mesh/mesh.hpp"
#include "evert/scene/config.hpp"

#include <span>

/// From the description of a body to its nodes and cells.
namespace evert {

/// Reads or generates the mesh and makes it the rest shape in the world: groups, fit, scale, rotate,
/// translate. Nodes that no kept cell uses are left out. Not collective: for rank 0. Throws UserError (bad
/// file, unknown group, a transform that leaves the numbers).
[[nodiscard]] Mesh make_body_mesh(const BodyConfig& body);

/// The corners of what holds all points. `points` must not be empty.
struct BoundingBox {
  Vec3d min{};
  Vec3d max{};

  [[nodiscard]] Vec3d center() const { return 0.5 * (min + max); }
};
[[nodiscard]] BoundingBox bounding_box(std::span<const Vec3d> points);

/// Where a node starts. `box` is that of the whole body at rest, `node` its number in the body's mesh: the
/// answer does not depend on how the mesh is spread over ranks.
[[nodiscard]] Vec3d start_position(const StartConfig& start, const BoundingBox& box, const Vec3d& rest,
                                   GlobalIndex node);

}  // namespace evert
