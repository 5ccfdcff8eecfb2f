#include "evert/core/error.hpp"
#include "evert/shapes/gear.hpp"
#include "evert/shapes/solids.hpp"
#include "evert/shapes/triangle_solid.hpp"

#include "level_set_checks.hpp"
#include <numbers>

namespace evert {
namespace {

const Vec3d& corner(const TriangleSurface& surface, const Triangle& t, std::size_t k) {
  return surface.points[static_cast<std::size_t>(t[k])];
}

/// Solid angle of the surface over 4π, 1 inside and 0 outside.  Van Oosterom and Strackee 1983
double winding_number(const TriangleSurface& surface, const Vec3d& x) {
  double sum = 0;
  for (const auto& t : surface.triangles) {
    const auto a = corner(surface, t, 0) - x, b = corner(surface, t, 1) - x, c = corner(surface, t, 2) - x;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

/// Least over all points of the triangle by nested ternary searches: slow, and nothing to get wrong.
/// Triangles whose corners are all too far for any of their points to be nearer are left out.
double slow_distance(const TriangleSurface& surface, const Vec3d& x) {
  const auto least = [](auto&& value) {
    double low = 0, high = 1;
    for (int n = 0; n < 45; ++n) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      const bool is_low = value(a) < value(b);
      (is_low ? high : low) = is_low ? b : a;
    }
    return value((low + high) / 2);
  };
  double squared = HUGE_VAL;
  for (const auto& t : surface.triangles) {
    const auto a = corner(surface, t, 0), ab = corner(surface, t, 1) - a, ac = corner(surface, t, 2) - a;
    const double reach = norm(ab) + norm(ac);
    if (norm(a - x) - reach > std::sqrt(squared)) continue;
    squared = std::min(squared, least([&](double u) {
                         return least([&](double v) {
                           const auto way = a + u * ab + (v * (1 - u)) * ac - x;
                           return dot(way, way);
                         });
                       }));
  }
  return std::sqrt(squared);
}

TriangleSurface block(const Vec3d& half) {
  TriangleSurface surface;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1}) surface.points.push_back({x * half[0], y * half[1], z * half[2]});
  surface.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                       {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return surface;
}

struct Case {
  const char* name;
  TriangleSurface surface;
};

std::vector<Case> cases() {
  return {{"block", block({0.5, 1, 0.25})},
          {"thin plate", block({0.5, 0.5e-3, 0.5})},
          {"plate of a micrometre", block({0.5, 0.5e-6, 0.5})},
          {"gear", triangulate(Gear(8, 0.25, 0.4, 0.2), {.cells = 16})},
          {"torus", triangulate(Torus(0.5, 0.2), {.cells = 16})}};
}

/// At any point, and at points that are so near a thin plate that only exact signs are right.
TEST(TriangleSolid, IsExactByBruteForce) {
  double worst = 0;
  int wrong_signs = 0;
  for (auto& [name, surface] : cases()) {
    SCOPED_TRACE(name);
    require_closed(surface, name);
    const TriangleSolid solid(surface);
    const auto size = solid.bounds().upper - solid.bounds().lower;
    const double scale = std::max({size[0], size[1], size[2]}), band = scale / 64;
    test::RandomPoints anywhere(test::grown(solid.bounds(), 0.2)), inside(solid.bounds()),
        choose({{}, {1, 1, 1}});
    for (int n = 0; n < 150; ++n) {
      auto x = n % 3 == 0 ? anywhere() : inside();
      if (n % 3 == 2) x += (1e-4 * scale) * (choose() - Vec3d{0.5, 0.5, 0.5});
      const double exact = slow_distance(surface, x), phi = solid.signed_distance(x);
      const bool is_inside = winding_number(surface, x) > 0.5;
      wrong_signs += (phi < 0) != is_inside ? 1 : 0;
      worst = std::max(worst, std::abs(phi - (is_inside ? -exact : std::min(exact, band))) / scale);
    }
  }
  EXPECT_EQ(wrong_signs, 0);
  // the nested search stops where squares of distances differ by rounding: half the digits
  EXPECT_LT(worst, 1e-7);
}

TEST(TriangleSolid, IsALevelSet) {
  for (const Vec3d size : {Vec3d{1, 2, 0.5}, Vec3d{1, 1e-3, 1}}) {
    const Box box(size);
    const TriangleSolid solid(block(0.5 * size));
    const double band = std::max({size[0], size[1], size[2]}) / 64;
    test::RandomPoints random(test::grown(box.bounds(), 0.1));
    for (int n = 0; n < 20000; ++n) {
      const auto x = random(), y = random();
      const double phi = solid.signed_distance(x);
      ASSERT_NEAR(phi, std::min(box.signed_distance(x), band), 1e-15);
      ASSERT_LE(std::abs(phi - solid.signed_distance(y)), norm(x - y) * (1 + 1e-12));
      const auto normal = solid.normal(x);
      ASSERT_NEAR(norm(normal), 1, 1e-12);
      if (phi < band) {
        ASSERT_NEAR(solid.signed_distance(x - phi * normal), 0, 1e-12);
      }
    }
  }
}

/// What the signs by the nearest face alone get wrong: corners at which faces turn back sharply.
TEST(TriangleSolid, KnowsTheSidesOfSpikes) {
  TriangleSurface spike{{{0, 0, 0}, {1, 0.01, 0}, {1, -0.01, 0.01}, {1, -0.01, -0.01}},
                        {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  require_closed(spike, "spike");
  const TriangleSolid solid(spike);
  test::RandomPoints near_tip({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}});
  for (int n = 0; n < 10000; ++n) {
    const auto x = near_tip();
    ASSERT_EQ(solid.signed_distance(x) < 0, winding_number(spike, x) > 0.5);
  }
}

std::string complaint(TriangleSurface surface) {
  try {
    require_closed(surface, "part.stl");
  } catch (const UserError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ClosedSurface, FacesOutwards) {
  auto surface = block({1, 1, 1});
  for (auto& t : surface.triangles) std::swap(t[0], t[1]);
  require_closed(surface, "inside out");
  EXPECT_EQ(TriangleSolid(surface).signed_distance({}), -1);
}

TEST(ClosedSurface, NamesWhatIsWrong) {
  const auto good = block({1, 1, 1});
  EXPECT_EQ(complaint(good), "nothing");
  EXPECT_EQ(complaint({}), "part.stl: has no triangle");
  auto open = good;
  open.triangles.pop_back();
  EXPECT_EQ(
      complaint(open),
      "part.stl: the surface is open: the edge from (-1, -1, 1) to (-1, 1, 1) of triangle 1 has no other "
      "triangle");
  auto doubled = good;
  doubled.triangles.push_back(good.triangles.front());
  EXPECT_EQ(complaint(doubled),
            "part.stl: the edge from (-1, -1, -1) to (-1, -1, 1) of triangle 1 has 3 triangles: must be 2");
  auto turned = good;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(
      complaint(turned),
      "part.stl: triangles 1 and 6 at the edge from (-1, -1, -1) to (-1, -1, 1) turn opposite ways round: "
      "all must be counter-clockwise seen from outside");
  auto flat = good;
  flat.points[7] = flat.points[5];
  EXPECT_EQ(complaint(flat), "part.stl: triangle 4 at (1, -1, -1) has no area");
  auto crossing = good;  // the middle of a side pulled out through the opposite one
  crossing.points.push_back({-2, 0, 0});
  crossing.triangles.erase(crossing.triangles.begin() + 2, crossing.triangles.begin() + 4);
  for (const auto& [a, b] : {std::pair(4, 6), std::pair(6, 7), std::pair(7, 5), std::pair(5, 4)})
    crossing.triangles.push_back({a, b, 8});
  EXPECT_NE(complaint(crossing).find("cut each other: the surface must not intersect itself"),
            std::string::npos)
      << complaint(crossing);
  auto two = good;
  for (const auto& p : good.points) two.points.push_back(p + Vec3d{1, 0.5, 0.25});
  for (const auto& t : good.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  EXPECT_NE(complaint(two).find("cut each other"), std::string::npos) << "two blocks that overlap";
}

}  // namespace
}  // namespace evert
