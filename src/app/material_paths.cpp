#include "material_paths.hpp"

#include "evert/materials/stress_measures.hpp"

namespace evert {
namespace {

PointResponse principal_response(const Material& material, const Vec3d& stretches) {
  return std::visit(
      [&](const auto& model) {
        return PointResponse{stretches, diagonal(model.principal_stress(stretches)), model.energy(stretches)};
      },
      material);
}

}  // namespace

PointResponse response_to(const Material& material, const Mat3d& deformation_gradient) {
  const auto svd = svd3(deformation_gradient);
  return std::visit(
      [&](const auto& model) {
        return PointResponse{svd.sigma, first_piola_kirchhoff(model, svd), model.energy(svd.sigma)};
      },
      material);
}

std::span<const PathInfo> all_paths() {
  static const std::array<PathInfo, 4> paths{
      {{DeformationPath::uniaxial, "uniaxial", "principal stretches (s, 1, 1)"},
       {DeformationPath::biaxial, "biaxial", "principal stretches (s, s, 1)"},
       {DeformationPath::volumetric, "volumetric", "principal stretches (s, s, s)"},
       {DeformationPath::shear, "shear", "F = I + (s - 1) x y^T, simple shear"}}};
  return paths;
}

PointResponse response_on_path(const Material& material, DeformationPath path, double s) {
  switch (path) {
    case DeformationPath::uniaxial:
      return principal_response(material, {s, 1, 1});
    case DeformationPath::biaxial:
      return principal_response(material, {s, s, 1});
    case DeformationPath::volumetric:
      return principal_response(material, {s, s, s});
    case DeformationPath::shear:
      break;
  }
  Mat3d f = identity<double>();
  f(0, 1) = s - 1;
  return response_to(material, f);
}

double leading_stress(DeformationPath path, const PointResponse& response) {
  return path == DeformationPath::shear ? response.stress(0, 1) : response.stress(0, 0);
}

}  // namespace evert
