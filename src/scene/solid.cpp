#include "solid.hpp"

#include "evert/core/error.hpp"
#include "evert/mesh/surface_reader.hpp"
#include "evert/shapes/figure.hpp"
#include "evert/shapes/gear.hpp"
#include "evert/shapes/solids.hpp"
#include "evert/shapes/triangle_solid.hpp"

#include <cmath>
#include <numbers>

namespace evert {
namespace {

template <class Shape>
concept HasParts = requires(const Shape& shape) {
  shape.of.front().solid;
};

/// What makes the solid of each shape.
class Maker {
 public:
  explicit Maker(const Surfaces& surfaces) : surfaces_(surfaces) {}

  Solid operator()(const HalfSpaceShape& s) const { return make<HalfSpace>(s.point, s.normal); }
  Solid operator()(const SphereShape& s) const { return make<Sphere>(s.radius); }
  Solid operator()(const BoxShape& s) const { return make<Box>(s.size); }
  Solid operator()(const RoundedBoxShape& s) const { return make<Box>(s.size, s.rounding); }
  Solid operator()(const EllipsoidShape& s) const { return make<Ellipsoid>(s.radii); }
  Solid operator()(const CapsuleShape& s) const { return make<Capsule>(s.radius, s.length); }
  Solid operator()(const CylinderShape& s) const { return make<Cone>(cylinder(s.radius, s.length)); }
  Solid operator()(const TorusShape& s) const { return make<Torus>(s.major_radius, s.minor_radius); }
  Solid operator()(const ConeShape& s) const { return make<Cone>(s.bottom_radius, s.top_radius, s.length); }
  Solid operator()(const GearShape& s) const {
    return make<Gear>(s.teeth, s.root_radius, s.tip_radius, s.width);
  }
  Solid operator()(const FigureShape& s) const { return figure(s.height); }
  Solid operator()(const MeshShape& s) const {
    auto surface = surfaces_.at(s.surface);
    for (auto& point : surface.points) point = s.scale * point;
    return make<TriangleSolid>(std::move(surface));
  }
  Solid operator()(const UnionShape& s) const { return make<Union>(parts(s.of)); }
  Solid operator()(const IntersectionShape& s) const { return make<Intersection>(parts(s.of)); }
  Solid operator()(const DifferenceShape& s) const { return difference(parts(s.of)); }

 private:
  template <class Shape, class... Arguments>
  static Solid make(Arguments&&... arguments) {
    return std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
  }

  [[nodiscard]] std::vector<Solid> parts(const std::vector<ShapeConfig>& shapes) const {
    std::vector<Solid> all;
    for (const auto& shape : shapes) {
      const auto rotation = shape.rotate ? rotation_of(*shape.rotate) : identity<double>();
      all.push_back(make<Placed>(make_solid(shape, surfaces_), rotation, shape.center));
    }
    return all;
  }

  const Surfaces& surfaces_;
};

}  // namespace

void add_files(const SolidConfig& solid, std::set<std::string>& paths) {
  std::visit(
      [&]<class Shape>(const Shape& shape) {
        if constexpr (HasParts<Shape>)
          for (const auto& part : shape.of) add_files(part.solid, paths);
        else if constexpr (std::is_same_v<Shape, MeshShape>)
          paths.insert(shape.surface);
      },
      solid);
}

bool names_file(const SolidConfig& solid) {
  std::set<std::string> paths;
  add_files(solid, paths);
  return !paths.empty();
}

void read_surfaces(const SolidConfig& solid, Surfaces& surfaces) {
  std::set<std::string> paths;
  add_files(solid, paths);
  for (const auto& path : paths)
    if (!surfaces.contains(path)) surfaces.emplace(path, read_closed_surface(path));
}

Solid make_solid(const ShapeConfig& shape, const Surfaces& surfaces) {
  auto solid = std::visit(Maker(surfaces), shape.solid);
  if (shape.grow != 0) solid = std::make_unique<Offset>(std::move(solid), shape.grow);
  require_not_empty(*solid, "the " + name_of(shape.solid));
  return solid;
}

/// Rodrigues' formula.
Mat3d rotation_of(const RotationConfig& rotate) {
  const double angle = rotate.angle * std::numbers::pi / 180;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto& a = rotate.axis;
  const Mat3d cross_axis{{{{0, a[2], -a[1]}, {-a[2], 0, a[0]}, {a[1], -a[0], 0}}}};
  return c * identity<double>() + s * cross_axis + (1 - c) * outer(a, a);
}

}  // namespace evert
