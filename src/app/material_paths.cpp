#include "material_paths.hpp"

namespace evert {
namespace {

PointResponse response_of(const PointMaterial& at, const Svd3<double>& svd) {
  return std::visit(
      [&](const auto& model) {
        return PointResponse{svd.sigma, first_piola_kirchhoff(model, svd, at.fibre),
                             energy_density(model, svd, at.fibre)};
      },
      at.material);
}

}  // namespace

PointResponse response_to(const PointMaterial& at, const Mat3d& deformation_gradient) {
  return response_of(at, svd3(deformation_gradient));
}

std::span<const PathInfo> paths_of(const Material& material) {
  static const std::array<PathInfo, 5> paths{
      {{DeformationPath::uniaxial, "uniaxial", "principal stretches (s, 1, 1)"},
       {DeformationPath::biaxial, "biaxial", "principal stretches (s, s, 1)"},
       {DeformationPath::volumetric, "volumetric", "principal stretches (s, s, s)"},
       {DeformationPath::shear, "shear", "F = I + (s - 1) x y^T, simple shear"},
       {DeformationPath::across, "across", "principal stretches (1, s, 1)"}}};
  return std::span(paths).first(has_fibres(material) ? 5 : 4);
}

PointResponse response_on_path(const PointMaterial& at, DeformationPath path, double s) {
  const auto stretched = [&](const Vec3d& stretches) {
    return response_of(at, {identity<double>(), stretches, identity<double>()});
  };
  switch (path) {
    case DeformationPath::uniaxial:
      return stretched({s, 1, 1});
    case DeformationPath::biaxial:
      return stretched({s, s, 1});
    case DeformationPath::volumetric:
      return stretched({s, s, s});
    case DeformationPath::across:
      return stretched({1, s, 1});
    case DeformationPath::shear:
      break;
  }
  Mat3d f = identity<double>();
  f(0, 1) = s - 1;
  return response_to(at, f);
}

double leading_stress(DeformationPath path, const PointResponse& response) {
  if (path == DeformationPath::shear) return response.stress(0, 1);
  return path == DeformationPath::across ? response.stress(1, 1) : response.stress(0, 0);
}

}  // namespace evert
