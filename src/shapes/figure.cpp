#include "evert/shapes/figure.hpp"

#include "evert/core/positive.hpp"
#include "evert/shapes/solids.hpp"

#include <cmath>

namespace evert {
namespace {

/// The parts in units of the height, the soles at y = 0. What stands beside the middle stands on both sides.
class Sculptor {
 public:
  explicit Sculptor(double height) : height_(height) {}

  void ellipsoid(const Vec3d& center, const Vec3d& radii) {
    place(std::make_unique<Ellipsoid>(height_ * radii), identity<double>(), center);
    if (center[0] != 0)
      place(std::make_unique<Ellipsoid>(height_ * radii), identity<double>(), mirrored(center));
  }

  /// A capsule between the points.
  void limb(const Vec3d& from, const Vec3d& to, double radius) {
    limb_on_one_side(from, to, radius);
    if (from[0] != 0 || to[0] != 0) limb_on_one_side(mirrored(from), mirrored(to), radius);
  }

  [[nodiscard]] std::vector<Solid> take() { return std::move(parts_); }

 private:
  [[nodiscard]] static Vec3d mirrored(const Vec3d& x) { return {-x[0], x[1], x[2]}; }

  void limb_on_one_side(const Vec3d& from, const Vec3d& to, double radius) {
    const auto way = to - from;
    const double length = norm(way);
    const auto y = (1 / length) * way;
    auto x = cross(y, std::abs(y[2]) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0});
    x = (1 / norm(x)) * x;
    place(std::make_unique<Capsule>(height_ * radius, height_ * length), Mat3d{{x, y, cross(x, y)}},
          0.5 * (from + to));
  }

  void place(Solid part, const Mat3d& rotation, const Vec3d& center) {
    const Vec3d above_soles{0, 0.5, 0};
    parts_.push_back(std::make_unique<Placed>(std::move(part), rotation, height_ * (center - above_soles)));
  }

  double height_;
  std::vector<Solid> parts_;
};

void head_and_trunk(Sculptor& s) {
  s.ellipsoid({0, 0.935, 0}, {0.046, 0.065, 0.054});
  s.ellipsoid({0, 0.925, 0.056}, {0.010, 0.014, 0.016});  // nose
  s.ellipsoid({0.048, 0.93, 0}, {0.010, 0.018, 0.012});   // ears
  s.limb({0, 0.80, -0.005}, {0, 0.89, 0}, 0.027);         // neck
  s.limb({-0.10, 0.785, 0}, {0.10, 0.785, 0}, 0.034);     // shoulders
  s.ellipsoid({0, 0.73, 0}, {0.095, 0.11, 0.062});        // chest
  s.ellipsoid({0, 0.61, 0}, {0.075, 0.11, 0.052});        // waist
  s.ellipsoid({0, 0.52, -0.005}, {0.088, 0.07, 0.062});   // hips
}

void arms(Sculptor& s) {
  s.limb({0.11, 0.785, 0}, {0.26, 0.75, -0.01}, 0.026);
  s.limb({0.26, 0.75, -0.01}, {0.40, 0.73, 0.01}, 0.019);
  s.ellipsoid({0.435, 0.725, 0.014}, {0.040, 0.015, 0.030});  // palm
  constexpr double finger = 1.0 / 120;
  for (const double spread : {-0.021, -0.007, 0.007, 0.021})
    s.limb({0.455, 0.724, 0.014 + spread}, {0.515, 0.716, 0.016 + 2.4 * spread}, finger);
  s.limb({0.42, 0.727, 0.034}, {0.445, 0.728, 0.066}, finger);  // thumb
}

void legs(Sculptor& s) {
  s.limb({0.048, 0.50, 0}, {0.060, 0.28, 0.005}, 0.042);
  s.limb({0.060, 0.28, 0.005}, {0.066, 0.06, -0.01}, 0.029);
  s.limb({0.066, 0.025, -0.02}, {0.072, 0.021, 0.055}, 0.021);  // foot
  s.limb({0.060, 0.012, 0.065}, {0.064, 0.012, 0.088}, 0.012);  // toes
  s.limb({0.082, 0.012, 0.062}, {0.088, 0.012, 0.080}, 0.012);
}

}  // namespace

Solid figure(double height) {
  require_positive(height, "height");
  Sculptor sculptor(height);
  head_and_trunk(sculptor);
  arms(sculptor);
  legs(sculptor);
  return std::make_unique<Union>(sculptor.take());
}

}  // namespace evert
