#pragma once
#include "evert/math/vec3.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

/// Solids as a scene writes them: for obstacles, and to be filled with tetrahedra. Centred on the origin;
/// those with an axis have the y axis.
namespace evert {

/// By the right-hand rule about the origin.
struct RotationConfig {
  Vec3d axis{{0, 0, 1}};  ///< unit vector
  double angle = 0;       ///< [degrees]
};

/// Everything on the far side of the plane is solid.
struct HalfSpaceShape {
  Vec3d normal{{0, 1, 0}};  ///< unit vector, out of the solid
  Vec3d point{};            ///< [m] a point of the plane
  double offset = 0;        ///< [m] normal · point
};
struct SphereShape {
  double radius = 0;  ///< [m]
};
struct BoxShape {
  Vec3d size{};  ///< [m]
};
struct RoundedBoxShape {
  Vec3d size{};         ///< [m]
  double rounding = 0;  ///< [m]
};
struct EllipsoidShape {
  Vec3d radii{};  ///< [m]
};
struct CapsuleShape {
  double radius = 0;  ///< [m]
  double length = 0;  ///< [m] of the cylinder alone
};
struct CylinderShape {
  double radius = 0;  ///< [m]
  double length = 0;  ///< [m]
};
struct TorusShape {
  double major_radius = 0;  ///< [m]
  double minor_radius = 0;  ///< [m]
};
struct ConeShape {
  double bottom_radius = 0;  ///< [m] at −length/2
  double top_radius = 0;     ///< [m] at length/2
  double length = 0;         ///< [m]
};
struct GearShape {
  int teeth = 0;
  double root_radius = 0;  ///< [m]
  double tip_radius = 0;   ///< [m]
  double width = 0;        ///< [m] along the axis
};
struct FigureShape {
  double height = 1;  ///< [m]
};
struct MeshShape {
  std::string surface;  ///< a file of triangles; relative ones are relative to the scene file; resolved here
  double scale = 1;     ///< [-] > 0
};

struct ShapeConfig;

struct UnionShape {
  std::vector<ShapeConfig> of;  ///< not empty
};
struct IntersectionShape {
  std::vector<ShapeConfig> of;  ///< not empty
};
/// The first without the others.
struct DifferenceShape {
  std::vector<ShapeConfig> of;  ///< not empty
};

using SolidConfig = std::variant<HalfSpaceShape, SphereShape, BoxShape, RoundedBoxShape, EllipsoidShape,
                                 CapsuleShape, CylinderShape, TorusShape, ConeShape, GearShape, FigureShape,
                                 MeshShape, UnionShape, IntersectionShape, DifferenceShape>;

/// A solid and its place: grown, then turned, then moved. A half-space has no place of its own.
struct ShapeConfig {
  SolidConfig solid;
  double grow = 0;  ///< [m]
  std::optional<RotationConfig> rotate{};
  Vec3d center{};  ///< [m]
};

/// As in a scene: "rounded_box".
[[nodiscard]] std::string name_of(const SolidConfig& solid);

}  // namespace evert
