#pragma once
#include "evert/materials/material.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What a material answers at one point: to a deformation gradient, and along paths of them.
namespace evert {

struct PointResponse {
  Vec3d stretches{};  ///< principal, signed
  Mat3d stress{};     ///< first Piola-Kirchhoff [Pa]
  double energy = 0;  ///< [J/m^3]
};

/// A material, and the direction of its fibres at rest where it has any.
struct PointMaterial {
  Material material;
  Vec3d fibre{{1, 0, 0}};  ///< unit vector
};

/// P and ψ of any F, as the elements compute them.
[[nodiscard]] PointResponse response_to(const PointMaterial& at, const Mat3d& deformation_gradient);

enum class DeformationPath {
  uniaxial,    ///< stretches (s, 1, 1)
  biaxial,     ///< stretches (s, s, 1)
  volumetric,  ///< stretches (s, s, s)
  shear,       ///< simple shear x + γ y, γ = s − 1: keeps the volume, inverts nothing
  across,      ///< stretches (1, s, 1): of materials with fibres
};

struct PathInfo {
  DeformationPath path;
  std::string name;
  std::string deformation;  ///< "F = diag(s, 1, 1)"
};
/// Those that tell something of a material; `across` is the last where it is among them.
[[nodiscard]] std::span<const PathInfo> paths_of(const Material& material);

/// The answer at s: on stretch paths that to the principal stretches as they are, of which several may be
/// negative. Elements never see those, since their F is a rotation of one with at most one negative stretch.
[[nodiscard]] PointResponse response_on_path(const PointMaterial& at, DeformationPath path, double s);

/// The stress that the path is about: along what is stretched, or P_xy of the shear. [Pa]
[[nodiscard]] double leading_stress(DeformationPath path, const PointResponse& response);

}  // namespace evert
