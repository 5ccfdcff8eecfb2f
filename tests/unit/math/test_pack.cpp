#include <gtest/gtest.h>

#include "cpu_levels.hpp"
#include "pack_operations.hpp"
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace evert::test {
namespace {

template <class Scalar>
constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
template <class Scalar>
constexpr Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();

/// Equal bit for bit, except that any NaN equals any other.
template <class Scalar>
bool same(Scalar a, Scalar b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return a == b && std::signbit(a) == std::signbit(b);
}

/// Every pair of awkward numbers, then random pairs; a multiple of 16 of them.
template <class Scalar>
void awkward_pairs(std::vector<Scalar>& x, std::vector<Scalar>& y) {
  using Limits = std::numeric_limits<Scalar>;
  const std::vector<Scalar> awkward{Scalar(0),     -Scalar(0),           Scalar(1),        Scalar(-1),
                                    Scalar(2.5),   Scalar(-3),           Limits::min(),    -Limits::min(),
                                    Limits::max(), Limits::denorm_min(), infinity<Scalar>, -infinity<Scalar>,
                                    nan<Scalar>,   Limits::epsilon(),    Scalar(0.1),      Scalar(1e-30)};
  for (const Scalar a : awkward) {
    for (const Scalar b : awkward) {
      x.push_back(a);
      y.push_back(b);
    }
  }
  std::mt19937_64 random(7);
  std::normal_distribution<Scalar> normal;
  for (int i = 0; i < 1024; ++i) {
    x.push_back(normal(random));
    y.push_back(normal(random));
  }
}

void run(const LevelKernels& level, Operation operation, const std::vector<double>& x,
         const std::vector<double>& y, std::vector<double>& result) {
  level.operate(operation, x.data(), y.data(), result.data(), x.size());
}
void run(const LevelKernels& level, Operation operation, const std::vector<float>& x,
         const std::vector<float>& y, std::vector<float>& result) {
  level.operate_float(operation, x.data(), y.data(), result.data(), x.size());
}

template <class Scalar>
class PackOf : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(PackOf, Scalars);

TYPED_TEST(PackOf, AgreesWithTheScalarBitForBit) {
  std::vector<TypeParam> x, y;
  awkward_pairs(x, y);
  std::vector<TypeParam> result(x.size());
  for (const LevelKernels* level : runnable_levels()) {
    for (int o = 0; o < int(Operation::count); ++o) {
      const auto operation = Operation(o);
      // Meaningful for positive normal numbers only, or not to the last bit: tested below.
      if (operation == Operation::logarithm || operation == Operation::power_of_two ||
          operation == Operation::exponential)
        continue;
      run(*level, operation, x, y, result);
      for (std::size_t i = 0; i < x.size(); ++i) {
        ASSERT_TRUE(same(result[i], apply(operation, x[i], y[i])))
            << level->name << " operation " << o << " of " << x[i] << ", " << y[i] << ": " << result[i];
      }
    }
  }
}

TYPED_TEST(PackOf, LogarithmIsAccurateToAnUlp) {
  using Limits = std::numeric_limits<TypeParam>;
  std::mt19937_64 random(11);
  const auto widest = std::log(Limits::max());
  std::vector<TypeParam> x{Limits::min(),
                           Limits::max(),
                           1,
                           std::nextafter(TypeParam(1), TypeParam(0)),
                           std::nextafter(TypeParam(1), TypeParam(2)),
                           std::sqrt(TypeParam(2)),
                           TypeParam(0.5),
                           2};
  while (x.size() < 1 << 18) {
    const bool near_one = x.size() % 2 == 0;
    const TypeParam reach = near_one ? TypeParam(0.5) : TypeParam(0.98) * widest;
    x.push_back(std::exp(std::uniform_real_distribution<TypeParam>(-reach, reach)(random)));
  }
  std::vector<TypeParam> result(x.size());
  for (const LevelKernels* level : runnable_levels()) {
    run(*level, Operation::logarithm, x, x, result);
    long double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = std::log(static_cast<long double>(x[i]));
      const auto rounded = static_cast<TypeParam>(std::abs(exact));
      const long double ulp = std::nextafter(rounded, infinity<TypeParam>) - rounded;
      ASSERT_TRUE(std::isfinite(result[i])) << x[i];
      worst = std::max(worst, std::abs(result[i] - exact) / ulp);
    }
    EXPECT_LT(worst, 1.0L) << level->name;
  }
}

TYPED_TEST(PackOf, LogarithmKeepsNaN) {
  std::vector<TypeParam> x(16, 1);
  x[3] = nan<TypeParam>;
  x[4] = infinity<TypeParam>;
  std::vector<TypeParam> result(16);
  for (const LevelKernels* level : runnable_levels()) {
    run(*level, Operation::logarithm, x, x, result);
    for (std::size_t i = 0; i < 16; ++i)
      EXPECT_EQ(std::isnan(result[i]), i == 3 || i == 4) << level->name << i;
  }
}

TYPED_TEST(PackOf, ExponentialIsAccurateToTwoUlp) {
  using Limits = std::numeric_limits<TypeParam>;
  std::mt19937_64 random(13);
  const TypeParam widest = sizeof(TypeParam) == 8 ? 708 : 87;
  std::vector<TypeParam> x{0, -TypeParam(0), Limits::denorm_min(), Limits::min(), widest, -widest, 1, -1};
  while (x.size() < 1 << 18) {
    const TypeParam reach = x.size() % 2 == 0 ? TypeParam(0.5) : widest;
    x.push_back(std::uniform_real_distribution<TypeParam>(-reach, reach)(random));
  }
  std::vector<TypeParam> result(x.size());
  for (const LevelKernels* level : runnable_levels()) {
    run(*level, Operation::exponential, x, x, result);
    EXPECT_EQ(result[0], 1);
    long double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = std::exp(static_cast<long double>(x[i]));
      const auto rounded = static_cast<TypeParam>(exact);
      const long double ulp = std::nextafter(rounded, infinity<TypeParam>) - rounded;
      worst = std::max(worst, std::abs(result[i] - exact) / ulp);
    }
    EXPECT_LT(worst, 2.0L) << level->name;
  }
}

TYPED_TEST(PackOf, ExponentialKeepsNaNAndStopsShortOfOverflow) {
  std::vector<TypeParam> x(16, 0);
  x[3] = nan<TypeParam>;
  x[4] = infinity<TypeParam>;
  x[5] = -infinity<TypeParam>;
  x[6] = std::numeric_limits<TypeParam>::max();
  std::vector<TypeParam> result(16);
  for (const LevelKernels* level : runnable_levels()) {
    run(*level, Operation::exponential, x, x, result);
    EXPECT_TRUE(std::isnan(result[3])) << level->name;
    EXPECT_TRUE(std::isfinite(result[4]) && result[4] > std::exp(TypeParam(80))) << level->name;
    EXPECT_TRUE(result[5] > 0 && result[5] < std::exp(TypeParam(-80))) << level->name;
    EXPECT_EQ(result[6], result[4]) << level->name;
  }
}

TYPED_TEST(PackOf, PowerOfTwoIsTheLargestNotAbove) {
  using Limits = std::numeric_limits<TypeParam>;
  std::vector<TypeParam> x;
  for (int exponent = Limits::min_exponent - 1; exponent < Limits::max_exponent; ++exponent) {
    const TypeParam power = std::ldexp(TypeParam(1), exponent);
    x.insert(x.end(), {power, std::nextafter(2 * power, TypeParam(0)), TypeParam(1.5) * power});
  }
  x.insert(x.end(), {infinity<TypeParam>, nan<TypeParam>});
  x.resize((x.size() / 16 + 1) * 16, TypeParam(1));
  std::vector<TypeParam> result(x.size());
  for (const LevelKernels* level : runnable_levels()) {
    run(*level, Operation::power_of_two, x, x, result);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const TypeParam expected =
          std::isfinite(x[i]) ? std::ldexp(TypeParam(1), std::ilogb(x[i])) : infinity<TypeParam>;
      EXPECT_EQ(result[i], expected) << level->name << " " << x[i];
      EXPECT_EQ(floor_power_of_two(x[i]), expected) << x[i];
    }
  }
}

TEST(Scalar, OperationsHaveTheirMeaning) {
  EXPECT_EQ(min(2.0, 1.0), 1.0);
  EXPECT_EQ(max(2.0, 1.0), 2.0);
  EXPECT_TRUE(std::isnan(min(nan<double>, 1.0)));
  EXPECT_TRUE(std::isnan(max(nan<double>, 1.0)));
  EXPECT_EQ(max(1.0, nan<double>), 1.0);
  EXPECT_EQ(select(true, 1.0, 2.0), 1.0);
  EXPECT_EQ(select(false, 1.0, 2.0), 2.0);
  EXPECT_EQ(copysign(-3.0, 2.0), 3.0);
  EXPECT_EQ(multiply_sign(-3.0, -2.0), 3.0);
  EXPECT_EQ(multiply_sign(-3.0, -0.0), 3.0);
  EXPECT_EQ(multiply_sign(-3.0, 0.0), -3.0);
  EXPECT_EQ(sqrt(9.0L), 3.0L);
  EXPECT_EQ(floor_power_of_two(5.0L), 4.0L);
  EXPECT_EQ(floor_power_of_two(std::ldexp(1.5L, -5000)), std::ldexp(1.0L, -5000));
  EXPECT_EQ(log(1.0F), 0.0F);
}

TEST(Scalar, HasOneLane) {
  static_assert(lanes_v<double> == 1 && lanes_v<long double> == 1 && lanes_v<float> == 1);
  static_assert(std::is_same_v<scalar_t<Pack>, double> && std::is_same_v<scalar_t<FloatPack>, float>);
  static_assert(std::is_same_v<mask_t<double>, bool>);
  static_assert(Real<Pack> && Real<long double> && !Real<int>);
  EXPECT_EQ(lane(4.0, 0), 4.0);
  EXPECT_TRUE(any(true) && all(true) && !any(false));
}

TEST(Mask, AnyAndAllLookAtEveryLane) {
  for (std::size_t set = 0; set < lanes_v<Pack>; ++set) {
    const Pack x = generate<Pack>([&](std::size_t i) { return i == set ? 1.0 : 0.0; });
    EXPECT_TRUE(any(x > Pack(0.5)));
    EXPECT_FALSE(all(x > Pack(0.5)));
    EXPECT_FALSE(all(x < Pack(0.5)));
    EXPECT_TRUE(all(x < Pack(2)));
    EXPECT_FALSE(any(x > Pack(2)));
  }
}

TEST(Levels, AreAsWideAsTheirRegisters) {
  ASSERT_FALSE(runnable_levels().empty());
  for (const LevelKernels* level : runnable_levels()) {
    EXPECT_EQ(level->float_lanes, 2 * level->double_lanes);
    const std::string name = level->name;
    const std::size_t expected = name == "v4" ? 8 : name == "v3" ? 4 : 2;
    EXPECT_EQ(level->double_lanes, expected) << name;
  }
}

}  // namespace
}  // namespace evert::test
