#pragma once
#include "evert/math/box3.hpp"
#include "evert/shapes/triangle_surface.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace evert {

/// The point of a surface that is nearest to another, and the part of a triangle that it lies on: its face,
/// an edge (from corner `edge` to the next), or a corner.
struct NearestPart {
  double squared;  ///< distance [m²]
  Vec3d point;
  std::size_t triangle;
  std::int8_t edge = -1, corner = -1;
};

/// From a point to a box, 0 inside [m²].
[[nodiscard]] double squared_distance(const Box3& box, const Vec3d& x);

/// A tree of boxes around the triangles of a surface, which is not empty.
class TriangleTree {
 public:
  explicit TriangleTree(TriangleSurface surface);

  [[nodiscard]] const TriangleSurface& surface() const { return surface_; }
  [[nodiscard]] const Box3& bounds() const { return nodes_.front().box; }
  [[nodiscard]] const Vec3d& corner(std::size_t triangle, std::size_t k) const {
    return surface_.points[static_cast<std::size_t>(surface_.triangles[triangle][k])];
  }
  [[nodiscard]] NearestPart nearest(const Vec3d& x) const;

  /// Calls visit(first, second), first < second, for the pairs of triangles whose boxes overlap.
  template <class Visit>
  void for_each_close_pair(Visit&& visit) const {
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
      for_each_overlapping(box_of(t), 0, [&](std::size_t other) {
        if (other > t) visit(t, other);
      });
  }

 private:
  /// Triangles order_[first] to order_[first + count); or, with count 0, the next node and `second`.
  struct Node {
    Box3 box;
    std::size_t first = 0, count = 0, second = 0;
  };

  void build(std::size_t first, std::size_t end);
  [[nodiscard]] Box3 box_of(std::size_t triangle) const;
  [[nodiscard]] NearestPart on_triangle(std::size_t triangle, const Vec3d& x) const;

  template <class Visit>
  void for_each_overlapping(const Box3& box, std::size_t at, Visit&& visit) const {
    const auto& node = nodes_[at];
    if (!node.box.overlaps(box)) return;
    for (std::size_t i = node.first; i < node.first + node.count; ++i)
      if (box_of(order_[i]).overlaps(box)) visit(order_[i]);
    if (node.count > 0) return;
    for_each_overlapping(box, at + 1, visit);
    for_each_overlapping(box, node.second, visit);
  }

  TriangleSurface surface_;
  std::vector<std::size_t> order_;  // triangles as the leaves hold them
  std::vector<Node> nodes_;
};

}  // namespace evert
