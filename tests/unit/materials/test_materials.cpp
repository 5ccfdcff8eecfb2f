#include "evert/materials/pair_moduli.hpp"
#include "evert/math/dual.hpp"
#include "evert/math/pack.hpp"

#include <gtest/gtest.h>

#include "models.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

/// Single-point drivers: every model, as functions of the principal stretches alone.
namespace evert {
namespace {

using namespace test;
using Number = Dual<double>;
constexpr Lame lame = firm;

template <class Model>
class Materials : public testing::Test {};
TYPED_TEST_SUITE(Materials, Models);

TYPED_TEST(Materials, StressIsTheGradientOfTheEnergy) {
  const auto model = make<TypeParam>(Extension::linear);
  for (const Vec3d& sigma : sample_stretches(limit_of(model))) {
    const Vec3d stress = model.principal_stress(sigma);
    for (int i = 0; i < 3; ++i) {
      Vec3<Number> varied{sigma[0], sigma[1], sigma[2]};
      varied[i].derivative = 1;
      EXPECT_NEAR(model.energy(varied).derivative, stress[i], 1e-13 * (norm(stress) + lame.mu))
          << sigma[0] << ' ' << sigma[1] << ' ' << sigma[2];
    }
  }
}

TYPED_TEST(Materials, StressIsTheGradientOfTheEnergyByFiniteDifferences) {
  const auto model = make<TypeParam>(Extension::linear);
  const double h = 1e-5;
  for (const Vec3d& sigma : sample_stretches(limit_of(model))) {
    const Vec3d stress = model.principal_stress(sigma);
    for (int i = 0; i < 3; ++i) {
      Vec3<long double> forward{sigma[0], sigma[1], sigma[2]};
      Vec3<long double> backward = forward;
      forward[i] += h;
      backward[i] -= h;
      const auto slope = static_cast<double>((model.energy(forward) - model.energy(backward)) / (2 * h));
      // The stress has a corner at the limit, which a central difference across it rounds off.
      const bool at_corner = std::abs(sigma[i] - limit_of(model)) < 2 * h;
      EXPECT_NEAR(slope, stress[i], (at_corner ? 3e-4 : 1e-7) * (norm(stress) + lame.mu));
    }
  }
}

TYPED_TEST(Materials, StressDerivativeIsTheDerivativeOfTheStress) {
  const auto model = make<TypeParam>(Extension::linear);
  for (const Vec3d& sigma : sample_stretches(limit_of(model))) {
    const Mat3d tangent = model.stress_derivative(sigma);
    const double scale = norm(tangent.column[0]) + norm(tangent.column[1]) + norm(tangent.column[2]);
    for (int j = 0; j < 3; ++j) {
      Vec3<Number> varied{sigma[0], sigma[1], sigma[2]};
      varied[j].derivative = 1;
      const Vec3<Number> stress = model.principal_stress(varied);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(stress[i].derivative, tangent(i, j), 1e-13 * scale)
            << sigma[0] << ' ' << sigma[1] << ' ' << sigma[2];
        EXPECT_EQ(tangent(i, j), tangent(j, i));
      }
    }
  }
}

TYPED_TEST(Materials, SmallStrainModuliAreThoseOfHookesLaw) {
  for (const Extension extension : {Extension::linear, Extension::clamp}) {
    const auto model = make<TypeParam>(extension);
    const Vec3d at_rest{1, 1, 1};
    EXPECT_EQ(model.energy(at_rest), 0);
    EXPECT_EQ(norm(model.principal_stress(at_rest)), 0);
    const Mat3d tangent = model.stress_derivative(at_rest);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        EXPECT_NEAR(tangent(i, j), lame.lambda + (i == j ? 2 * lame.mu : 0), 1e-12 * lame.lambda);
      }
    }
  }
}

/// ∮ P̂·dσ round a polygon through the compressed and inverted range. Its edges are split where they cross a
/// kink, so that P̂ is smooth on each piece and Gauss-Legendre panels integrate it to rounding.
TYPED_TEST(Materials, AClosedLoopDoesNoWork) {
  const auto model = make<TypeParam>(Extension::linear);
  const std::array<Vec3d, 5> corners{
      {{1.2, 0.9, 0.7}, {0.4, 1.5, -0.8}, {1.8, -0.3, 0.1}, {2.0, 1.1, -1.5}, {0.2, 0.25, 0.9}}};
  const std::array nodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                         0.9061798459386640};
  const std::array weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                           0.2369268850561891};
  double work = 0;
  double travelled = 0;
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    const Vec3d from = corners[corner];
    const Vec3d step = corners[(corner + 1) % corners.size()] - from;
    std::vector<double> breaks{0, 1};
    for (const double kink : kinks_of(model))
      for (int i = 0; i < 3; ++i) breaks.push_back(std::clamp((kink - from[i]) / step[i], 0.0, 1.0));
    std::sort(breaks.begin(), breaks.end());
    for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
      const int panels = 200;
      const double width = (breaks[piece + 1] - breaks[piece]) / panels;
      for (int panel = 0; panel < panels; ++panel) {
        for (std::size_t q = 0; q < nodes.size(); ++q) {
          const double t = breaks[piece] + width * (panel + 0.5 * (1 + nodes[q]));
          const double power = dot(model.principal_stress(from + t * step), step);
          work += 0.5 * width * weights[q] * power;
          travelled += 0.5 * width * weights[q] * std::abs(power);
        }
      }
    }
  }
  EXPECT_LE(std::abs(work), 1e-12 * travelled);
}

TYPED_TEST(Materials, StressBelowTheLimitAlwaysRisesWithTheStretch) {
  const auto model = make<TypeParam>(Extension::linear);
  const double limit = limit_of(model);
  for (double a = 0.2; a <= 3; a += 0.2) {
    for (double b = 0.2; b <= 3; b += 0.2) {
      double below = model.principal_stress(Vec3d{a, b, -2.0})[2];
      for (int i = 1; i <= 200; ++i) {
        const double stretch = -2 + (limit + 2) * i / 200;
        const double stress = model.principal_stress(Vec3d{a, b, stretch})[2];
        EXPECT_GT(stress, below) << a << ' ' << b << ' ' << stretch;
        below = stress;
      }
    }
  }
}

/// Uniaxial compression from rest to flat and on to the mirror image: the element is always pushed back.
TYPED_TEST(Materials, UniaxialStressActsToUninvert) {
  const auto model = make<TypeParam>(Extension::linear);
  double above = 0;
  for (int i = 1; i <= 3000; ++i) {
    const double stretch = 1 - 0.001 * i;
    const double stress = model.principal_stress(Vec3d{1, 1, stretch})[2];
    EXPECT_LT(stress, above) << stretch;
    above = stress;
  }
}

/// ∂P̂_3/∂σ_3 > 0 from the limit down to −2, other stretches in [0.2, 3].
TYPED_TEST(Materials, StiffnessBelowTheLimitIsPositive) {
  const auto model = make<TypeParam>();
  for (double a = 0.2; a < 3.05; a += 0.1)
    for (double b = 0.2; b < 3.05; b += 0.1)
      for (double stretch = limit_of(model) - 1e-9; stretch > -2; stretch -= 0.05)
        EXPECT_GT(model.stress_derivative(Vec3d{a, b, stretch})(2, 2), 0) << a << ' ' << b << ' ' << stretch;
}

/// How far an element can be stretched along the two other axes and still be pressed out of the flat state:
/// as far as docs/materials.md says. The size of λ decides, so for several ν.
template <class Model>
bool presses_flat_outwards(const Model& model, double a, double b) {
  return model.principal_stress(Vec3d{a, b, 0.0})[2] < 0;
}
bool is_pressed_as_documented(const RotatedLinear& model, double a, double b) {
  return model.lame.lambda * (a + b - 2) < 2 * model.lame.mu + model.lame.lambda;
}
bool is_pressed_as_documented(const Spline& model, double a, double b) {
  const double at_flat = 0.5 * (1 + (model.compression_stiffening - 1) / 3) +
                         0.5 * model.compression_stiffening;  // |D(−1)|, limit at ½
  return model.lame.lambda * (a + b - 2) < 2 * model.lame.mu * at_flat + model.lame.lambda;
}
bool is_pressed_as_documented(const StVenantKirchhoff& model, double a, double b) {
  const double limit = model.compression_limit;
  const auto strain = [&](double stretch) {  // continued linearly
    const double c = std::max(stretch, limit);
    return 0.5 * (c * c - 1) + c * (stretch - c);
  };
  return model.lame.lambda * (strain(a) + strain(b)) <
         (model.lame.mu + 0.5 * model.lame.lambda) * (1 + limit * limit);
}
bool is_pressed_as_documented(const NeoHookean& model, double a, double b) {
  const auto logarithm = [&](double stretch) {  // continued linearly
    const double c = std::max(stretch, model.compression_limit);
    return std::log(c) + stretch / c - 1;
  };
  const bool pressed = model.lame.lambda * (logarithm(a) + logarithm(b) + logarithm(0)) < 2 * model.lame.mu;
  EXPECT_TRUE(pressed || model.lame.lambda < 0);
  return pressed;
}
template <class Model>
bool is_pressed_as_documented(const Model& /*model*/, double /*a*/, double /*b*/) {
  return true;
}

TYPED_TEST(Materials, PressFlatElementsOutwardsAsFarAsDocumented) {
  auto model = make<TypeParam>();
  for (const double nu : {-0.5, 0.0, 0.3, 0.45, 0.49}) {
    model.lame = Lame::from_young_poisson(1, nu);
    for (double a = 0.203; a < 3; a += 0.1)
      for (double b = 0.203; b < 3; b += 0.1)
        EXPECT_EQ(presses_flat_outwards(model, a, b), is_pressed_as_documented(model, a, b))
            << nu << ' ' << a << ' ' << b;
  }
}

/// Only the model that is smooth in F does not feel that it has no extent left across two or three axes.
TYPED_TEST(Materials, PressOutwardsWhenCollapsed) {
  const auto model = make<TypeParam>();
  const Vec3d at_point = model.principal_stress(Vec3d{0, 0, 0});
  const Vec3d at_line = model.principal_stress(Vec3d{1, 0, 0});
  if constexpr (HasSpinModuli<TypeParam>) {
    EXPECT_EQ(norm(at_point), 0);
    EXPECT_EQ(std::abs(at_line[1]) + std::abs(at_line[2]), 0);
  } else {
    for (int i = 0; i < 3; ++i) EXPECT_LT(at_point[i], -0.1 * model.lame.mu);
    for (int i = 1; i < 3; ++i) EXPECT_LT(at_line[i], -0.1 * model.lame.mu);
  }
}

TYPED_TEST(Materials, StressIsContinuousAtTheLimit) {
  const auto model = make<TypeParam>(Extension::linear);
  const double limit = limit_of(model);
  const Vec3d below = model.principal_stress(Vec3d{1.3, 0.8, limit * (1 - 1e-12)});
  const Vec3d above = model.principal_stress(Vec3d{1.3, 0.8, limit * (1 + 1e-12)});
  EXPECT_LT(norm(above - below), 1e-9 * norm(above));
}

TYPED_TEST(Materials, PacksAgreeWithScalars) {
  for (const Extension extension : {Extension::linear, Extension::clamp}) {
    const auto model = make<TypeParam>(extension);
    for (const Vec3d& sigma : sample_stretches(limit_of(model))) {
      const Vec3<Pack> packed{Pack(sigma[0]), Pack(sigma[1]), Pack(sigma[2])};
      const Vec3d stress = model.principal_stress(sigma);
      const Vec3<Pack> packed_stress = model.principal_stress(packed);
      const Mat3d tangent = model.stress_derivative(sigma);
      const Mat3<Pack> packed_tangent = model.stress_derivative(packed);
      const double scale = norm(stress) + norm(tangent.column[0]) + norm(tangent.column[1]);
      EXPECT_NEAR(lane(model.energy(packed), 1), model.energy(sigma), 1e-14 * scale * (1 + norm(sigma)));
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(lane(packed_stress[i], 1), stress[i], 1e-14 * scale * (1 + norm(sigma)));
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(lane(packed_tangent(i, j), 1), tangent(i, j), 1e-14 * scale);
      }
    }
  }
}

TYPED_TEST(Materials, ClampEvaluatesAtTheLimit) {
  if constexpr (has_extension<TypeParam>) {
    const auto model = make<TypeParam>(Extension::clamp);
    const double limit = model.compression_limit;
    const Vec3d at_limit = model.principal_stress(Vec3d{1.2, limit, limit});
    const Vec3d beyond = model.principal_stress(Vec3d{1.2, -0.4, 0.0});
    EXPECT_EQ(at_limit, beyond);
    EXPECT_EQ(model.energy(Vec3d{1.2, limit, limit}), model.energy(Vec3d{1.2, -0.4, 0.0}));
  }
}

/// Finite as long as the squares of the largest stretch and the product of the stretches are.
TYPED_TEST(Materials, EnormousAndTinyStretchesGiveFiniteStress) {
  const auto model = make<TypeParam>();
  for (const double huge : {1e50, 1e100}) {
    for (const Vec3d& sigma : {Vec3d{huge, 1, 0.5}, Vec3d{huge, 1 / huge, 0}, Vec3d{1, 1 / huge, -1 / huge},
                               Vec3d{0.0, 0.0, 0.0}, Vec3d{1 / huge, 1 / huge, 1 / huge}}) {
      const Vec3d stress = model.principal_stress(sigma);
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(stress[i])) << sigma[0] << ' ' << sigma[1];
    }
  }
}

TYPED_TEST(Materials, NaNStaysNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<Pack> sigma{Pack(1.0), Pack(1.0), Pack(1.0)};
    sigma[axis] = Pack(nan);
    const Vec3<Pack> stress = make<TypeParam>().principal_stress(sigma);
    EXPECT_TRUE(std::isnan(lane(stress[axis], 0)));
  }
}

/// What the documentation of the default says: the growth of the uniaxial stiffness from rest to the limit.
TEST(NeoHookean, StiffnessAtTheDefaultLimit) {
  const auto growth = [](double limit) {
    const NeoHookean model{.lame = Lame::from_young_poisson(1, 0.3), .compression_limit = limit};
    const auto stiffness = [&](double stretch) {
      return model.stress_derivative(Vec3d{1, 1, stretch})(2, 2);
    };
    return stiffness(limit) / stiffness(1);
  };
  EXPECT_NEAR(growth(NeoHookean::default_compression_limit), 14, 0.5);
  EXPECT_NEAR(growth(0.2), 35, 1.5);
}

TEST(MooneyRivlin, StiffnessAtTheDefaultLimit) {
  const auto growth = [](double limit) {
    const MooneyRivlin model{.lame = Lame::from_shear_bulk(1, 1), .compression_limit = limit};
    const auto stiffness = [&](double stretch) {
      return model.stress_derivative(Vec3d{1, 1, stretch})(2, 2);
    };
    return stiffness(limit) / stiffness(1);
  };
  EXPECT_NEAR(growth(MooneyRivlin::default_compression_limit), 19, 0.5);
  EXPECT_NEAR(growth(0.25), 48, 0.5);
}

/// The muscle of PHYSICS 10.
TEST(MooneyRivlin, FromConstants) {
  const auto muscle = MooneyRivlin::from_constants(6e4, 2e4, 6e4);
  EXPECT_DOUBLE_EQ(muscle.lame.mu, 1.6e5);
  EXPECT_DOUBLE_EQ(muscle.lame.bulk_modulus(), 6e4);
  EXPECT_DOUBLE_EQ(muscle.share_01, 0.25);
}

/// Convex in each stretch below the limit whatever the others are: what the header proves.
TEST(MooneyRivlin, IsConvexBelowTheLimitWhateverTheOtherStretches) {
  const auto model = make<MooneyRivlin>();
  for (const Vec3d& sigma : sample_stretches(limit_of(model)))
    for (int i = 0; i < 3; ++i)
      if (sigma[i] < model.compression_limit) {
        EXPECT_GT(model.stress_derivative(sigma)(i, i), 0);
      }
}

TEST(Spline, HasTheGivenSlopes) {
  const Spline model{.lame = {0, 0.5},
                     .compression_limit = 0.4,
                     .elongation_limit = 1.7,
                     .compression_stiffening = 5,
                     .elongation_stiffening = 0.25};
  const auto slope = [&](double stretch) { return model.stress_derivative(Vec3d{stretch, 1, 1})(0, 0); };
  EXPECT_DOUBLE_EQ(slope(1), 1);
  EXPECT_DOUBLE_EQ(slope(0.4), 5);
  EXPECT_DOUBLE_EQ(slope(-3), 5);
  EXPECT_DOUBLE_EQ(slope(1.7), 0.25);
  EXPECT_DOUBLE_EQ(slope(4), 0.25);
}

TEST(Spline, WithLimitsAtRestIsLinear) {
  const Spline model{.lame = {1, 0.5}, .compression_limit = 1, .elongation_limit = 1};
  const RotatedLinear linear{.lame = {1, 5}};
  for (const Vec3d& sigma : sample_stretches(0.5)) {
    EXPECT_NEAR(norm(model.principal_stress(sigma) - linear.principal_stress(sigma)), 0, 1e-14);
    EXPECT_NEAR(model.energy(sigma), linear.energy(sigma), 1e-14 * model.energy(sigma));
  }
}

TEST(Lame, FromShearAndBulk) {
  const Lame rubber = Lame::from_shear_bulk(3, 5);
  EXPECT_DOUBLE_EQ(rubber.mu, 3);
  EXPECT_DOUBLE_EQ(rubber.lambda, 3);
  EXPECT_DOUBLE_EQ(rubber.bulk_modulus(), 5);
}

TEST(Lame, FromYoungAndPoisson) {
  const Lame steel = Lame::from_young_poisson(210e9, 0.3);
  EXPECT_NEAR(steel.mu, 210e9 / 2.6, 1e-3);
  EXPECT_NEAR(steel.lambda, 2 * steel.mu * 0.3 / 0.4, 1e-3);
}

}  // namespace
}  // namespace evert
