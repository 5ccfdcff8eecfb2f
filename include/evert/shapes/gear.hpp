#pragma once
#include "evert/shapes/solids.hpp"

#include <vector>

namespace evert {

/// A spur gear around the y axis, a tooth on the x axis. Between the root and the tip circle the flanks are
/// involutes of 20° pressure angle about the pitch circle halfway, where tooth and gap are alike: so that two
/// gears whose pitch circles touch mesh. Where an involute would make the tooth pointed or the gap closed, it
/// is made less curved. A flank is a polyline; the distance to that solid is exact.
class Gear final : public ExactSolid {
 public:
  /// `teeth` ≥ 3, 0 < `root_radius` < `tip_radius`, `width` > 0 along the axis [m]. Throws UserError.
  Gear(int teeth, double root_radius, double tip_radius, double width);
  [[nodiscard]] Box3 bounds() const override;

 protected:
  [[nodiscard]] SignedDistance near(const Vec3d& x) const override;

 private:
  struct Point {
    double x, z;
  };
  /// In the plane of the gear.
  struct FlatDistance {
    double value;
    Point normal;
  };
  [[nodiscard]] FlatDistance in_plane(const Point& p) const;
  [[nodiscard]] FlatDistance in_half_tooth(const Point& p) const;
  [[nodiscard]] bool is_inside(const Point& p) const;

  double half_tooth_;  // π over the number of teeth
  double root_, tip_, half_width_;
  std::vector<Point> flank_;  // from the root circle to the tip circle, for the tooth on the x axis, z ≥ 0
};

}  // namespace evert
