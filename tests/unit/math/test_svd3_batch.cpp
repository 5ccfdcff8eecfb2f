#include "evert/math/svd3_batch.hpp"

#include <gtest/gtest.h>

#include "svd3_families.hpp"
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace evert::test {
namespace {

constexpr double bound = 1e-14;  // PHYSICS 2 asks for 1e-13

std::vector<Svd3BatchLevel> supported() {
  std::vector<Svd3BatchLevel> levels;
  for (const Svd3BatchLevel& level : svd3_batch_levels()) {
    if (level.supported) levels.push_back(level);
  }
  return levels;
}

/// Of every family in turn.
std::vector<Mat3d> awkward_matrices(std::size_t count) {
  Random random(31);
  std::vector<Mat3d> f;
  for (std::size_t i = 0; i < count; ++i) f.push_back(families()[i % families().size()].sample(random));
  return f;
}

double distance_to_rotation(const Mat3d& m) {
  return norm(transpose_times(m, m) - identity<double>()) + std::abs(determinant(m) - 1);
}

bool same(const Svd3<double>& a, const Svd3<double>& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

/// Powers of two in and out, so that the squares of norms neither overflow nor vanish.
double error_of(const Mat3d& f, const Svd3<double>& svd) {
  const auto [unit, scale] = scale_to_unit(f);
  const Mat3d product = times_transpose(svd.u * diagonal((1 / scale) * svd.sigma), svd.v);
  return norm(unit) == 0 ? norm(product) : norm(product - unit) / norm(unit);
}

TEST(Svd3Batch, IsAccurateOnEveryFamilyAtEveryLevel) {
  const std::vector<Mat3d> f = awkward_matrices(50'000);  // more than stay in a cache
  for (const Svd3BatchLevel& level : supported()) {
    std::vector<Svd3<double>> svd(f.size());
    level.run(f.data(), f.size(), svd.data());
    for (std::size_t i = 0; i < f.size(); ++i) {
      SCOPED_TRACE(std::string(level.name) + ", " + std::string(families()[i % families().size()].name));
      ASSERT_LE(error_of(f[i], svd[i]), bound);
      ASSERT_LE(distance_to_rotation(svd[i].u), 2 * bound);
      ASSERT_LE(distance_to_rotation(svd[i].v), 2 * bound);
      ASSERT_GE(svd[i].sigma[0], svd[i].sigma[1]);
      ASSERT_GE(svd[i].sigma[1], std::abs(svd[i].sigma[2]));
    }
  }
}

/// Every number of matrices around the widths of packs and runs: each result is that of the whole, and
/// nothing is written behind the last. Starts at any alignment.
TEST(Svd3Batch, OfAnyCount) {
  const std::vector<Mat3d> f = awkward_matrices(200);
  for (const Svd3BatchLevel& level : supported()) {
    std::vector<Svd3<double>> whole(f.size());
    level.run(f.data(), f.size(), whole.data());
    for (std::size_t count = 0; count < 140; ++count) {
      for (const std::size_t start : {std::size_t{0}, std::size_t{1}}) {
        const Svd3<double> untouched{{}, {7, 7, 7}, {}};
        // Exactly as many as there are, for the sanitizers.
        const std::vector<Mat3d> some(f.begin() + static_cast<std::ptrdiff_t>(start),
                                      f.begin() + static_cast<std::ptrdiff_t>(start + count));
        std::vector<Svd3<double>> svd(count + 1, untouched);
        level.run(some.data(), count, svd.data());
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_TRUE(same(svd[i], whole[start + i])) << level.name << ", " << i << " of " << count;
        ASSERT_TRUE(same(svd[count], untouched)) << level.name << ", " << count;
      }
    }
  }
}

/// Past the caches or not, aligned or not: the same bits.
TEST(Svd3Batch, OfManyIsThatOfFew) {
  const std::vector<Mat3d> f = awkward_matrices(20'011);
  for (const Svd3BatchLevel& level : supported()) {
    std::vector<Svd3<double>> many(f.size() + 1), few(f.size());
    level.run(f.data(), f.size(), many.data() + 1);
    for (std::size_t i = 0; i < f.size(); i += 100)
      level.run(f.data() + i, std::min<std::size_t>(100, f.size() - i), few.data() + i);
    for (std::size_t i = 0; i < f.size(); ++i)
      ASSERT_TRUE(same(many[i + 1], few[i])) << level.name << ", " << i;
  }
}

TEST(Svd3Batch, ChoosesALevelOfThisCpu) {
  const std::vector<Mat3d> f = awkward_matrices(100);
  std::vector<Svd3<double>> svd(f.size());
  svd3_batch(f, svd);
  bool found = false;
  for (const Svd3BatchLevel& level : supported()) {
    std::vector<Svd3<double>> of_level(f.size());
    level.run(f.data(), f.size(), of_level.data());
    found = found || std::memcmp(svd.data(), of_level.data(), svd.size() * sizeof(svd[0])) == 0;
  }
  EXPECT_TRUE(found);
}

TEST(Svd3Batch, NotANumberStaysWithItsMatrix) {
  std::vector<Mat3d> f = awkward_matrices(40);
  std::vector<Svd3<double>> before(f.size()), svd(f.size());
  svd3_batch(f, before);
  f[17](1, 2) = std::numeric_limits<double>::quiet_NaN();
  svd3_batch(f, svd);
  EXPECT_TRUE(std::isnan(svd[17].sigma[0]));
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_EQ(same(svd[i], before[i]), i != 17) << i;
  }
}

}  // namespace
}  // namespace evert::test
