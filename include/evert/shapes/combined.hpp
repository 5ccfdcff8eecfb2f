#pragma once
#include "evert/shapes/implicit_surface.hpp"

#include <memory>
#include <vector>

/// Solids made of solids.
namespace evert {

using Solid = std::unique_ptr<ImplicitSurface>;

/// What is in any of the parts. φ is exact outside if that of the parts is, and at most too near inside.
class Union final : public ImplicitSurface {
 public:
  /// At least one part.
  explicit Union(std::vector<Solid> parts) : parts_(std::move(parts)) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override;
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override;
  [[nodiscard]] Box3 bounds() const override;

 private:
  std::vector<Solid> parts_;
};

/// What is in all of the parts. φ is exact inside if that of the parts is, and at most too near outside.
class Intersection final : public ImplicitSurface {
 public:
  /// At least one part.
  explicit Intersection(std::vector<Solid> parts) : parts_(std::move(parts)) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override;
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override;
  [[nodiscard]] Box3 bounds() const override;

 private:
  std::vector<Solid> parts_;
};

/// Everything that is not in a solid.
class Complement final : public ImplicitSurface {
 public:
  explicit Complement(Solid solid) : solid_(std::move(solid)) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override { return -solid_->signed_distance(x); }
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override { return -solid_->normal(x); }
  [[nodiscard]] Box3 bounds() const override { return Box3::everything(); }

 private:
  Solid solid_;
};

/// The first of the parts without the others: an intersection with their complements.
[[nodiscard]] Solid difference(std::vector<Solid> parts);

/// A solid grown by `distance` [m], or shrunk where that is negative. Its outer edges become round where φ is
/// exact outside, and stay sharp else.
class Offset final : public ImplicitSurface {
 public:
  Offset(Solid solid, double distance) : solid_(std::move(solid)), distance_(distance) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override {
    return solid_->signed_distance(x) - distance_;
  }
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override { return solid_->normal(x); }
  [[nodiscard]] Box3 bounds() const override;

 private:
  Solid solid_;
  double distance_;
};

/// A solid turned, then moved.
class Placed final : public ImplicitSurface {
 public:
  Placed(Solid solid, const Mat3d& rotation, const Vec3d& center)
      : solid_(std::move(solid)), rotation_(rotation), center_(center) {}
  [[nodiscard]] double signed_distance(const Vec3d& x) const override {
    return solid_->signed_distance(inwards(x));
  }
  [[nodiscard]] Vec3d normal(const Vec3d& x) const override { return rotation_ * solid_->normal(inwards(x)); }
  [[nodiscard]] Box3 bounds() const override;
  [[nodiscard]] std::optional<TriangleSurface> own_triangles(const Fineness& fineness) const override;

 private:
  [[nodiscard]] Vec3d inwards(const Vec3d& x) const { return transpose_times(rotation_, x - center_); }

  Solid solid_;
  Mat3d rotation_;
  Vec3d center_;
};

/// Around a box that is turned about the origin, then moved.
[[nodiscard]] Box3 placed(const Box3& box, const Mat3d& rotation, const Vec3d& center);

/// Throws UserError when no point of a grid over its bounds is inside: what shapes combine to can be empty.
/// `name` is for the message. Without bounds it is taken to be not.
void require_not_empty(const ImplicitSurface& solid, const std::string& name);

}  // namespace evert
