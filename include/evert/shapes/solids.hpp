#pragma once
#include "evert/shapes/implicit_surface.hpp"

/// Solids with exact distances. All are centred on the origin, those that have an axis around the y axis, so
/// that they lie or stand where y is up. Lengths in metres; UserError when one is not positive and finite.
namespace evert {

/// A distance with its gradient.
struct SignedDistance {
  double value = 0;  ///< [m] negative inside
  Vec3d normal{};    ///< unit
};

/// A solid that finds its distance and its normal in one go.
class ExactSolid : public ImplicitSurface {
 public:
  [[nodiscard]] double signed_distance(const Vec3d& x) const final { return near(x).value; }
  [[nodiscard]] Vec3d normal(const Vec3d& x) const final { return near(x).normal; }

 protected:
  [[nodiscard]] virtual SignedDistance near(const Vec3d& x) const = 0;
};

/// A box with edges along the axes, rounded by balls of radius `rounding` ≥ 0, less than half its shortest
/// side.
class Box final : public ExactSolid {
 public:
  explicit Box(const Vec3d& size, double rounding = 0);
  [[nodiscard]] Box3 bounds() const override;

 protected:
  [[nodiscard]] SignedDistance near(const Vec3d& x) const override;

 private:
  Vec3d core_;  // half the sides without the rounding
  double rounding_;
};

class Ellipsoid final : public ExactSolid {
 public:
  explicit Ellipsoid(const Vec3d& radii);
  [[nodiscard]] Box3 bounds() const override { return {-radii_, radii_}; }

 protected:
  [[nodiscard]] SignedDistance near(const Vec3d& x) const override;

 private:
  Vec3d radii_;
};

/// A cylinder with a half ball at both ends; `length` is that of the cylinder alone.
class Capsule final : public ExactSolid {
 public:
  Capsule(double radius, double length);
  [[nodiscard]] Box3 bounds() const override;

 protected:
  [[nodiscard]] SignedDistance near(const Vec3d& x) const override;

 private:
  double radius_, half_length_;
};

/// `minor_radius` < `major_radius`.
class Torus final : public ExactSolid {
 public:
  Torus(double major_radius, double minor_radius);
  [[nodiscard]] Box3 bounds() const override;

 protected:
  [[nodiscard]] SignedDistance near(const Vec3d& x) const override;

 private:
  double major_radius_, minor_radius_;
};

/// The cone from a disk of radius `bottom` at −length/2 to one of radius `top` at length/2: a cylinder when
/// they are alike. One of them may be zero: a tip.
class Cone final : public ExactSolid {
 public:
  Cone(double bottom_radius, double top_radius, double length);
  [[nodiscard]] Box3 bounds() const override;

 protected:
  [[nodiscard]] SignedDistance near(const Vec3d& x) const override;

 private:
  double bottom_, top_, half_length_;
};

/// A cylinder: the cone with two alike radii.
[[nodiscard]] Cone cylinder(double radius, double length);

}  // namespace evert
