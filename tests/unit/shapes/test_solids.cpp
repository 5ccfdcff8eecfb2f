#include "evert/core/error.hpp"
#include "evert/shapes/gear.hpp"
#include "evert/shapes/solids.hpp"

#include "level_set_checks.hpp"
#include <memory>
#include <numbers>

namespace evert {
namespace {

using test::expect_exact;

template <class Shape>
test::Subject subject(std::string name, Shape shape, std::function<bool(const Vec3d&)> is_inside) {
  return {std::move(name), std::make_shared<Shape>(std::move(shape)), std::move(is_inside)};
}

double radius(const Vec3d& x) { return std::hypot(x[0], x[2]); }

bool in_box(const Vec3d& x, const Vec3d& half) {
  return std::abs(x[0]) < half[0] && std::abs(x[1]) < half[1] && std::abs(x[2]) < half[2];
}

bool in_rounded_box(const Vec3d& x, const Vec3d& core, double rounding) {
  Vec3d beyond{};
  for (std::size_t k = 0; k < 3; ++k) beyond[k] = std::max(std::abs(x[k]) - core[k], 0.0);
  return norm(beyond) < rounding;
}

TEST(Solids, SphereIsExact) {
  expect_exact(subject("sphere", Sphere(0.7), [](const Vec3d& x) { return norm(x) < 0.7; }));
}

TEST(Solids, BoxIsExact) {
  expect_exact(subject("box", Box({1, 2, 0.5}), [](const Vec3d& x) { return in_box(x, {0.5, 1, 0.25}); }));
  expect_exact(subject("thin plate", Box({1, 1e-3, 1}), [](const Vec3d& x) {
    return in_box(x, {0.5, 0.5e-3, 0.5});
  }));
  expect_exact(subject("rounded box", Box({1, 2, 0.5}, 0.1), [](const Vec3d& x) {
    return in_rounded_box(x, {0.4, 0.9, 0.15}, 0.1);
  }));
}

TEST(Solids, EllipsoidIsExact) {
  for (const Vec3d radii : {Vec3d{1, 0.5, 1.3}, Vec3d{1, 1, 1}, Vec3d{0.2, 2, 0.2}, Vec3d{1, 0.01, 0.7}})
    expect_exact(subject("ellipsoid", Ellipsoid(radii), [=](const Vec3d& x) {
      return std::pow(x[0] / radii[0], 2) + std::pow(x[1] / radii[1], 2) + std::pow(x[2] / radii[2], 2) < 1;
    }));
}

/// The points where the closed equation has no single root.
TEST(Solids, EllipsoidKnowsItsPlanesOfSymmetry) {
  const Ellipsoid solid({1, 0.5, 1.3});
  EXPECT_NEAR(solid.signed_distance({}), -0.5, 1e-15) << "the centre";
  EXPECT_NEAR(solid.signed_distance({0, 2, 0}), 1.5, 1e-15);
  EXPECT_NEAR(solid.signed_distance({0, 0, -1.4}), 0.1, 1e-14);
  EXPECT_NEAR(solid.signed_distance({1, 0, 0}), 0, 1e-15);
  // in the plane y = 0 of the ellipse (x/1)² + (y/0.5)² = 1, before its focal curve: x_q = x/(1 − 0.25)
  const double x = 0.3, foot = x / 0.75, height = 0.5 * std::sqrt(1 - foot * foot);
  EXPECT_NEAR(solid.signed_distance({x, 0, 0}), -std::hypot(x - foot, height), 1e-14);
  EXPECT_NEAR(Ellipsoid({2, 2, 2}).signed_distance({}), -2, 1e-15);
}

TEST(Solids, CapsuleIsExact) {
  expect_exact(subject("capsule", Capsule(0.3, 1), [](const Vec3d& x) {
    return norm(Vec3d{x[0], x[1] - std::clamp(x[1], -0.5, 0.5), x[2]}) < 0.3;
  }));
}

TEST(Solids, TorusIsExact) {
  expect_exact(subject("torus", Torus(0.5, 0.2),
                       [](const Vec3d& x) { return std::hypot(radius(x) - 0.5, x[1]) < 0.2; }));
}

TEST(Solids, CylinderIsExact) {
  expect_exact(subject("cylinder", cylinder(0.4, 2),
                       [](const Vec3d& x) { return radius(x) < 0.4 && std::abs(x[1]) < 1; }));
}

TEST(Solids, ConeIsExact) {
  const auto cone = [](double bottom, double top, double length) {
    return subject("cone", Cone(bottom, top, length), [=](const Vec3d& x) {
      return std::abs(x[1]) < length / 2 && radius(x) < bottom + (top - bottom) * (x[1] / length + 0.5);
    });
  };
  expect_exact(cone(0.5, 0, 1));
  expect_exact(cone(0.5, 0.2, 1));
  expect_exact(cone(0.1, 0.8, 0.3));
  expect_exact(cone(0, 0.8, 0.3));
}

/// Brute force judges the distance by the sign, and the next test the sign by the drawing of a gear.
TEST(Solids, GearIsExact) {
  for (const int teeth : {3, 8, 40}) {
    const auto solid = std::make_shared<Gear>(teeth, 0.25, 0.4, 0.2);
    expect_exact({"gear", solid, [=](const Vec3d& x) { return solid->signed_distance(x) < 0; }});
  }
}

TEST(Solids, GearHasItsTeeth) {
  const int teeth = 8;
  const Gear gear(teeth, 0.25, 0.4, 0.2);
  const auto at = [&](double r, double turn) {
    const double angle = 2 * std::numbers::pi / teeth * turn;
    return gear.signed_distance({r * std::cos(angle), 0, r * std::sin(angle)});
  };
  for (int tooth = 0; tooth < teeth; ++tooth) {
    EXPECT_NEAR(at(0.4, tooth), 0, 1e-15) << "the tip";
    EXPECT_NEAR(at(0.25, tooth + 0.5), 0, 1e-15) << "the root";
    EXPECT_LT(at(0.32, tooth + 0.24), 0) << "tooth and gap are alike at the pitch circle";
    EXPECT_GT(at(0.33, tooth + 0.26), 0);
  }
  EXPECT_NEAR(gear.signed_distance({0, 0.3, 0}), 0.2, 1e-15);
}

/// Two gears whose pitch circles touch, turned against each other by half a tooth, do not overlap.
TEST(Solids, GearsMesh) {
  const Gear gear(12, 0.3, 0.4, 0.2);
  double deepest = 0;
  for (int step = 0; step < 20; ++step) {
    const double turn = std::numbers::pi / 6 * step / 20;
    for (int n = 0; n < 20000; ++n) {
      const double angle = 2 * std::numbers::pi * n / 20000, c = std::cos(turn), s = std::sin(turn);
      for (const double r : {0.3, 0.32, 0.34, 0.35, 0.36, 0.38, 0.4}) {
        const Vec3d x{r * std::cos(angle), 0, r * std::sin(angle)};
        const Vec3d first{c * x[0] - s * x[2], 0, s * x[0] + c * x[2]};
        const double half = std::numbers::pi / 12;  // a gap of the second faces a tooth of the first
        const Vec3d apart{x[0] - 0.7, 0, x[2]};
        const double c2 = std::cos(half - turn), s2 = std::sin(half - turn);
        const Vec3d second{c2 * apart[0] - s2 * apart[2], 0, s2 * apart[0] + c2 * apart[2]};
        deepest = std::min(deepest, std::max(gear.signed_distance(first), gear.signed_distance(second)));
      }
    }
  }
  // chords instead of arcs, and the base circle above the root: a hundredth of a tooth
  EXPECT_GT(deepest, -0.001);
}

TEST(Solids, RefuseWhatIsNoSolid) {
  const auto complaint = [](auto&& make) -> std::string {
    try {
      make();
    } catch (const UserError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_EQ(complaint([] { return Sphere(-1); }), "radius is -1, but must be a positive finite length");
  EXPECT_EQ(complaint([] { return Box({1, 0, 1}); }), "size is 0, but must be a positive finite length");
  EXPECT_EQ(complaint([] {
              return Box({1, 0.2, 1}, 0.1);
            }),
            "rounding is 0.1, but must be in [0, 0.1): less than half the shortest side of the box");
  EXPECT_EQ(complaint([] { return Torus(0.2, 0.2); }),
            "minor_radius is 0.2, but must be less than major_radius, 0.2");
  EXPECT_EQ(
      complaint([] { return Cone(0, 0, 1); }),
      "bottom_radius is 0 and top_radius 0, but must be at least 0, finite, and one of them more than 0");
  EXPECT_EQ(complaint([] { return Gear(2, 1, 2, 1); }), "teeth is 2, but must be at least 3");
  EXPECT_EQ(complaint([] { return Gear(9, 2, 2, 1); }),
            "tip_radius is 2, but must be more than root_radius, 2");
  EXPECT_EQ(complaint([] {
              return Ellipsoid({1, HUGE_VAL, 1});
            }),
            "radii is inf, but must be a positive finite length");
}

}  // namespace
}  // namespace evert
