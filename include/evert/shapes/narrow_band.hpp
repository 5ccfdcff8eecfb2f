#pragma once
#include "evert/shapes/triangle_surface.hpp"

#include <memory>

namespace evert {

/// Tells in constant time whether a point is farther from a closed surface than a given distance, and on
/// which side. By OpenVDB.
class NarrowBand {
 public:
  virtual ~NarrowBand() = default;
  /// The distance to the surface is at least `width`, and the point is outside. May be false where it is so.
  [[nodiscard]] virtual bool is_far_outside(const Vec3d& x) const = 0;
};

/// Null where Evert was built without OpenVDB. `width` [m] is two voxels.
[[nodiscard]] std::shared_ptr<const NarrowBand> make_narrow_band(const TriangleSurface& surface,
                                                                 double width);

}  // namespace evert
