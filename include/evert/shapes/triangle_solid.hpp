#pragma once
#include "evert/shapes/implicit_surface.hpp"
#include "evert/shapes/narrow_band.hpp"
#include "evert/shapes/triangle_tree.hpp"

#include <memory>
#include <vector>

namespace evert {

/// What a closed surface of triangles encloses. φ is the distance to the triangles inside, and outside up to
/// 1/64 of the longest side of its bounds; farther out it is that width.
///
/// The nearest triangle is found in a tree of boxes. Its sign is that of the angle-weighted normal of the
/// face, edge or corner that is nearest (Baerentzen and Aanaes 2005, Signed distance computation using the
/// angle weighted pseudonormal), which is right for plates of any thinness. Points beyond the band, where no
/// triangle need be found, are told by OpenVDB where Evert was built with it: the same φ, sooner.
class TriangleSolid final : public ImplicitSurface {
 public:
  /// `surface`: as require_closed() accepts it.
  explicit TriangleSolid(TriangleSurface surface);
  [[nodiscard]] double signed_distance(const Vec3d& x) const override;
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override;
  [[nodiscard]] Box3 bounds() const override { return tree_.bounds(); }
  [[nodiscard]] std::optional<TriangleSurface> own_triangles(const Fineness& /*fineness*/) const override {
    return tree_.surface();
  }

 private:
  void set_normals();
  [[nodiscard]] const Vec3d& normal_of(const NearestPart& found) const;

  TriangleTree tree_;
  std::vector<Vec3d> face_normals_, corner_normals_;  // unit; by triangle, by point
  std::vector<std::array<Vec3d, 3>> edge_normals_;    // by triangle
  double band_ = 0;                                   // [m]
  std::shared_ptr<const NarrowBand> narrow_band_;     // null without OpenVDB
};

/// Throws UserError, naming `name`, unless the surface can be a solid: every edge between two triangles that
/// turn the same way round, no triangle without area, none that cuts another. Turns all triangles round where
/// they face inwards.
void require_closed(TriangleSurface& surface, const std::string& name);

}  // namespace evert
