#include "evert/shapes/narrow_band.hpp"

#ifdef EVERT_WITH_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

namespace evert {
namespace {

/// A grid of distances around the surface; beyond the band only the sides are known, flooded from outside. In
/// the width of three voxels that the band has, one is left for the way from a point to the nearest point of
/// the grid (√3/2 voxels) and for the float numbers of the grid.
class VdbBand final : public NarrowBand {
 public:
  VdbBand(const TriangleSurface& surface, double width) : per_metre_(2 / width) {
    constexpr float half_width = 3;
    // the ranks are the parallelism
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const auto& p : surface.points) points.emplace_back(openvdb::Vec3d(p[0], p[1], p[2]) * per_metre_);
    for (const auto& [a, b, c] : surface.triangles) triangles.emplace_back(a, b, c);
    const auto voxels = openvdb::math::Transform::createLinearTransform(1);
    grid_ = openvdb::tools::meshToSignedDistanceField<openvdb::FloatGrid>(*voxels, points, triangles, {},
                                                                          half_width, half_width);
  }

  [[nodiscard]] bool is_far_outside(const Vec3d& x) const override {
    const openvdb::Vec3d at(x[0] * per_metre_, x[1] * per_metre_, x[2] * per_metre_);
    float value = 0;
    const bool is_in_band = grid_->tree().probeValue(openvdb::Coord::round(at), value);
    return !is_in_band && value > 0;
  }

 private:
  double per_metre_;  // voxels
  openvdb::FloatGrid::Ptr grid_;
};

}  // namespace

std::shared_ptr<const NarrowBand> make_narrow_band(const TriangleSurface& surface, double width) {
  return std::make_shared<VdbBand>(surface, width);
}

}  // namespace evert
#else
namespace evert {

std::shared_ptr<const NarrowBand> make_narrow_band(const TriangleSurface& /*surface*/, double /*width*/) {
  return {};
}

}  // namespace evert
#endif
