#include "svd3_families.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace evert::test {

namespace {

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

bool coin(Random& random) { return (random() >> 63) != 0; }

double random_sign(Random& random) { return coin(random) ? 1.0 : -1.0; }

/// ±10^-e with e uniform in [0, decades].
double graded(Random& random, double decades) {
  return random_sign(random) * std::pow(10.0, -uniform(random, 0, decades));
}

template <class Entry>
Mat3d filled(Entry entry) {
  Mat3d m;
  for (auto& column : m.column) {
    for (double& e : column.components) e = entry();
  }
  return m;
}

Mat3d gaussian(Random& random) {
  std::normal_distribution<double> normal;
  return filled([&] { return normal(random); });
}

/// Of a unit quaternion, or one of the 24 rotations of the cube.
Mat3d rotation(Random& random) {
  const bool of_cube = random() % 8 == 0;
  double x = uniform(random, -1, 1), y = uniform(random, -1, 1), z = uniform(random, -1, 1),
         w = uniform(random, -1, 1);
  if (of_cube) x = std::round(x), y = std::round(y), z = std::round(z), w = 1;
  const double s = 2 / (x * x + y * y + z * z + w * w);
  return {{{{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
            {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
            {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}}}};
}

Mat3d with_singular_values(Random& random, const Vec3d& sigma) {
  return times_transpose(rotation(random) * diagonal(sigma), rotation(random));
}

Mat3d near_rotation(Random& random) { return rotation(random) + graded(random, 17) * gaussian(random); }

Mat3d repeated(Random& random) {
  const double a = uniform(random, 0.1, 2), b = coin(random) ? a : uniform(random, 0, 2);
  const double sign = random_sign(random);
  return with_singular_values(random, coin(random) ? Vec3d{a, a, sign * b} : Vec3d{a, b, sign * b});
}

Mat3d nearly_repeated(Random& random) {
  const double sign = random_sign(random);
  return with_singular_values(random, {1, 1 + graded(random, 17), sign * (1 + graded(random, 17))});
}

Mat3d inverted(Random& random) {
  return with_singular_values(random,
                              {uniform(random, 0.1, 3), uniform(random, 0.1, 3), -uniform(random, 0, 3)});
}

Mat3d rank_one(Random& random) {
  const Mat3d g = gaussian(random);
  if (coin(random)) return outer(g.column[0], g.column[1]);
  const auto rounded = [](const Vec3d& a) {
    return Vec3d{std::round(3 * a[0]), std::round(3 * a[1]), std::round(3 * a[2])};
  };
  return outer(rounded(g.column[0]), rounded(g.column[1]));  // exactly of rank one or zero
}

Mat3d rank_two(Random& random) {
  Mat3d g = gaussian(random);
  if (coin(random)) g = filled([&] { return double(random() % 7) - 3; });
  const std::size_t dependent = random() % 3;
  g.column[dependent] = g.column[(dependent + 1) % 3] - g.column[(dependent + 2) % 3];
  return coin(random) ? g : transpose(g);
}

Mat3d flattened(Random& random) {
  return with_singular_values(random, {1, graded(random, 18), graded(random, 18)});
}

Mat3d collapsed(Random& random) {
  return with_singular_values(random, {1, graded(random, 320), graded(random, 320)});
}

Mat3d scaled(Random& random) {
  const double scale = coin(random) ? 1e150 : 1e-150;
  switch (random() % 4) {
    case 0:
      return scale * gaussian(random);
    case 1:
      return scale * nearly_repeated(random);
    case 2:
      return scale * flattened(random);
    default:
      return graded(random, 150) * scale * rank_two(random);
  }
}

Mat3d graded_entries(Random& random) {
  const double decades = coin(random) ? 20 : 300;
  return filled([&] { return graded(random, decades); });
}

Mat3d aligned_with_axes(Random& random) {
  Mat3d m = diagonal<double>(
      {graded(random, 20), coin(random) ? 1 : graded(random, 200), coin(random) ? 0 : graded(random, 20)});
  std::swap(m.column[0], m.column[random() % 3]);
  std::swap(m.column[1], m.column[random() % 3]);
  return m;
}

Mat3d awkward_entries(Random& random) {
  constexpr double e = 0x1p-52;
  static const std::vector<std::vector<double>> sets{
      {0, 1, -1},
      {0, 1, -1, e, -e, 1 + e, 1 - e / 2, -1 - e},
      {0, 1, -1, 1e-8, -1e-8, 1 + 1e-8, 1 - 1e-8},
      {0, 1, -1, 1e-16, 1e-5, -1e-11},
      {0, 1, -1, 1e-100, -1e-60, 1e-30},
      {0, 1e-100, -1e-100, 1e-108, 1e-116},
      {0, 1e100, -1e100, 1e92, 1e84, 1},
      {0, 1e150, -1e150, 1e-150, -1e-150},
      {0, 1, -1, 1e-146, -1e-145, 1e-154, 1e-162, 1e-290},
      {0, 1, 2, 3, -1, -2, -3},
      {1, 1 + e, 1 + 2 * e, 1 - e, 1 - e / 2},
      {0, 1, -1, 1e-20, 1e-40},
      {0, 0.5, 2, -0.25, 1e-9},
      {-0.0, 1, -1},
      {0, 0x1p1021, -0x1p1021, 0x1.fffffffffffffp1021, 0x1p1000},
      {0, 0x1p-960, -0x1p-960, 0x1p-965, 0x1p-1000}};
  const auto& set = sets[random() % sets.size()];
  return filled([&] { return set[random() % set.size()]; });
}

constexpr std::array<Family, 14> all_families{{{"gaussian", gaussian},
                                               {"near rotation", near_rotation},
                                               {"repeated", repeated},
                                               {"nearly repeated", nearly_repeated},
                                               {"inverted", inverted},
                                               {"rank one", rank_one},
                                               {"rank two", rank_two},
                                               {"flattened", flattened},
                                               {"collapsed", collapsed},
                                               {"scaled", scaled},
                                               {"graded entries", graded_entries},
                                               {"aligned with axes", aligned_with_axes},
                                               {"awkward entries", awkward_entries},
                                               {"rotation", rotation}}};

}  // namespace

std::span<const Family> families() { return all_families; }

}  // namespace evert::test
