#pragma once
#include "evert/contact/obstacle.hpp"

#include <memory>
#include <span>
#include <vector>

/// Which bodies a node is in.  docs/design/contact.md
namespace evert {

/// Where a node was at the beginning of a step, and where its velocity took it.
struct Way {
  Vec3d from, to;
};

/// A box with what rounding may put beside it: of the distances involved.
inline constexpr double on_surface = 1e-10;
[[nodiscard]] inline Box3 around(const Box3& box) {
  return box.grown(on_surface * (norm(box.lower) + norm(box.upper)));
}

/// A body that a node is in, or on.
struct Touch {
  std::size_t obstacle;  ///< its number
  Vec3d normal;          ///< of the surface, outward
  double depth;          ///< [m] from the place where the node is to the surface, along the normal
};

class ContactSearch {
 public:
  /// Obstacles are kept by reference, and are to be moved to the end of the step before what follows.
  explicit ContactSearch(std::span<const std::unique_ptr<Obstacle>> obstacles);

  /// The obstacles that may reach into `box`, sorted; valid until the next call.
  [[nodiscard]] std::span<const std::size_t> near(const Box3& box);

  /// Adds the bodies of `near` that the end of `way` is in. A way that leads through a body, however thin it
  /// is, ends from now on where it goes in.
  void find(Way& way, std::span<const std::size_t> near, std::vector<Touch>& touches) const;

  /// Adds those that a node at `way.to` would be in after a `change` that takes it out of others. Depths
  /// count from `way.to`. True if there is any.
  bool find_after(const Way& way, const Vec3d& change, std::span<const std::size_t> near,
                  std::vector<Touch>& touches) const;

 private:
  std::span<const std::unique_ptr<Obstacle>> obstacles_;
  std::vector<std::size_t> near_;
};

}  // namespace evert
