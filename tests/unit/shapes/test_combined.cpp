#include "evert/core/error.hpp"
#include "evert/shapes/combined.hpp"
#include "evert/shapes/solids.hpp"

#include "level_set_checks.hpp"

namespace evert {
namespace {

template <class... Shapes>
std::vector<Solid> parts(Shapes... shapes) {
  std::vector<Solid> all;
  (all.push_back(std::make_unique<Shapes>(std::move(shapes))), ...);
  return all;
}

Placed at(const Vec3d& center, auto shape) {
  return {std::make_unique<decltype(shape)>(std::move(shape)), identity<double>(), center};
}

bool in_ball(const Vec3d& x, const Vec3d& center, double radius) { return norm(x - center) < radius; }

TEST(Combined, UnionsAreLevelSets) {
  const Vec3d second{0.6, 0, 0};
  test::expect_level_set({"union", std::make_shared<Union>(parts(Sphere(0.5), at(second, Sphere(0.4)))),
                          [=](const Vec3d& x) { return in_ball(x, {}, 0.5) || in_ball(x, second, 0.4); }});
}

TEST(Combined, IntersectionsAreLevelSets) {
  const Vec3d second{0.6, 0, 0};
  test::expect_level_set({"intersection",
                          std::make_shared<Intersection>(parts(Sphere(0.5), at(second, Sphere(0.4)))),
                          [=](const Vec3d& x) { return in_ball(x, {}, 0.5) && in_ball(x, second, 0.4); }});
  test::expect_level_set({"half a ball",
                          std::make_shared<Intersection>(parts(Sphere(0.5), HalfSpace({}, {0, 1, 0}))),
                          [=](const Vec3d& x) { return in_ball(x, {}, 0.5) && x[1] < 0; }});
}

TEST(Combined, DifferencesAreLevelSets) {
  const std::shared_ptr<ImplicitSurface> drilled = difference(parts(Box({1, 1, 1}), cylinder(0.3, 2)));
  test::expect_level_set({"drilled box", drilled, [](const Vec3d& x) {
                            return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}) < 0.5 &&
                                   std::hypot(x[0], x[2]) >= 0.3;
                          }});
}

TEST(Combined, AnOffsetBoxIsARoundedBox) {
  const Offset grown(std::make_unique<Box>(Vec3d{0.8, 1.8, 0.3}), 0.1);
  const Box rounded({1, 2, 0.5}, 0.1);
  test::RandomPoints random(test::grown(rounded.bounds(), 0.5));
  for (int n = 0; n < 1000; ++n) {
    const auto x = random();
    EXPECT_NEAR(grown.signed_distance(x), rounded.signed_distance(x), 1e-15);
    EXPECT_NEAR(norm(grown.normal(x) - rounded.normal(x)), 0, 1e-14);
  }
  EXPECT_NEAR(norm(grown.bounds().upper - rounded.bounds().upper), 0, 1e-15);
}

TEST(Combined, PlacedSolidsAreExact) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Mat3d about_z{{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}}};
  const Vec3d center{1, 2, 3};
  test::expect_exact({"turned box",
                      std::make_shared<Placed>(std::make_unique<Box>(Vec3d{1, 2, 0.5}), about_z, center),
                      [=](const Vec3d& x) {
                        const auto y = transpose_times(about_z, x - center);
                        return std::abs(y[0]) < 0.5 && std::abs(y[1]) < 1 && std::abs(y[2]) < 0.25;
                      }});
}

TEST(Combined, EmptyOnesAreRefused) {
  const auto complaint = [](const ImplicitSurface& solid) -> std::string {
    try {
      require_not_empty(solid, "shape");
    } catch (const UserError& error) {
      return error.what();
    }
    return "nothing";
  };
  const std::string empty = "shape is empty: no point is inside";
  EXPECT_EQ(complaint(Intersection(parts(Sphere(1), at({3, 0, 0}, Sphere(1))))), empty) << "boxes apart";
  EXPECT_EQ(complaint(Intersection(parts(Sphere(1), at({1.5, 1.5, 0}, Sphere(1))))), empty)
      << "boxes overlap";
  EXPECT_EQ(complaint(*difference(parts(Sphere(1), Box({3, 3, 3})))), empty);
  EXPECT_EQ(complaint(Offset(std::make_unique<Sphere>(1), -1)), empty);
  EXPECT_EQ(complaint(Intersection(parts(Sphere(1), at({1.99, 0, 0}, Sphere(1))))), "nothing")
      << "a thin lens";
  EXPECT_EQ(complaint(Box({1, 1e-6, 1})), "nothing");
  EXPECT_EQ(complaint(HalfSpace({}, {0, 1, 0})), "nothing");
}

}  // namespace
}  // namespace evert
