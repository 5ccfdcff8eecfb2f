#pragma once
#include "evert/math/box3.hpp"
#include "evert/math/vec3.hpp"
#include "evert/shapes/triangle_surface.hpp"

#include <optional>

namespace evert {

/// A solid as a level set φ in its own frame, φ < 0 inside.  paper A, section 9
///
/// What contact needs: φ is 1-Lipschitz, and from a point inside, near the surface, a way −φ along the normal
/// ends on it. What the mesh generator needs: the sign of φ, and the bounds. Safe to ask from several
/// threads.
class ImplicitSurface {
 public:
  virtual ~ImplicitSurface() = default;

  /// Distance to the surface, negative inside [m]. Deep inside and far outside it may be nearer than it is.
  [[nodiscard]] virtual double signed_distance(const Vec3d& x) const = 0;
  /// Unit outward normal ∇φ, defined everywhere (any unit vector where the gradient is not).
  [[nodiscard]] virtual Vec3d normal(const Vec3d& x) const = 0;
  /// Contains the solid; infinite where it goes on for ever.
  [[nodiscard]] virtual Box3 bounds() const = 0;
  /// Better triangles than triangulate() finds by looking at φ, where the solid knows some.
  [[nodiscard]] virtual std::optional<TriangleSurface> own_triangles(const Fineness& /*fineness*/) const {
    return {};
  }
};

/// Everything behind the plane through `point` with outward normal `normal` (need not be unit; not zero).
class HalfSpace final : public ImplicitSurface {
 public:
  HalfSpace(const Vec3d& point, const Vec3d& normal) : point_(point), normal_((1 / norm(normal)) * normal) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override { return dot(x - point_, normal_); }
  [[nodiscard]] Vec3d normal(const Vec3d& /*x*/) const override { return normal_; }
  [[nodiscard]] Box3 bounds() const override { return Box3::everything(); }
  /// A square around the point.
  [[nodiscard]] std::optional<TriangleSurface> own_triangles(const Fineness& fineness) const override;

 private:
  Vec3d point_, normal_;
};

/// A ball of `radius` > 0 [m] around the origin.
class Sphere final : public ImplicitSurface {
 public:
  explicit Sphere(double radius);
  [[nodiscard]] double signed_distance(const Vec3d& x) const override { return norm(x) - radius_; }
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override {
    const double distance = norm(x);
    return distance > 0 ? (1 / distance) * x : Vec3d{0, 1, 0};
  }
  [[nodiscard]] Box3 bounds() const override {
    return {{-radius_, -radius_, -radius_}, {radius_, radius_, radius_}};
  }

 private:
  double radius_;
};

}  // namespace evert
