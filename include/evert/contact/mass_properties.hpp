#pragma once
#include "evert/shapes/implicit_surface.hpp"

/// Masses and inertia of rigid bodies of even density, in the frame of the body. Those made from a shape have
/// density 1 kg/m³; times() gives them another.
namespace evert {

struct MassProperties {
  double mass = 0;  ///< [kg]
  Vec3d center{};   ///< of mass [m]
  Mat3d inertia{};  ///< about that centre [kg m²]

  [[nodiscard]] MassProperties times(double factor) const {
    return {factor * mass, center, factor * inertia};
  }
};

/// A ball around the origin.
[[nodiscard]] MassProperties ball_mass(double radius);
/// A box of these edges around the origin.
[[nodiscard]] MassProperties box_mass(const Vec3d& size);
/// A cylinder of this length along y with a half ball at both ends, around the origin.
[[nodiscard]] MassProperties capsule_mass(double radius, double length);
/// What a closed surface encloses, exactly.
[[nodiscard]] MassProperties enclosed_mass(const TriangleSurface& surface);
/// Of a solid with finite bounds: by formula where there is one, else of its triangles.
[[nodiscard]] MassProperties mass_of(const ImplicitSurface& solid);

}  // namespace evert
