#include "evert/materials/material.hpp"
#include "evert/math/dual.hpp"
#include "evert/math/pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

/// Single-point drivers: every model, as functions of the principal stretches alone.
namespace evert {
namespace {

using Number = Dual<double>;

constexpr Lame lame = Lame::from_young_poisson(1e5, 0.4);

template <class Model>
Model make(Extension extension) {
  if constexpr (requires { Model::default_compression_limit; }) {
    return Model{.lame = lame, .extension = extension};
  } else {
    return Model{.lame = lame};
  }
}

template <class Model>
double limit_of(const Model& model) {
  if constexpr (requires { model.compression_limit; }) {
    return model.compression_limit;
  } else {
    return 0.5;
  }
}

/// Random stretches in [−2, 3], and every combination of the awkward ones: zero, the limit and its
/// neighbours, 1, repeated values.
std::vector<Vec3d> sample_stretches(double limit) {
  std::vector<Vec3d> samples;
  const std::array awkward{
      -2.0, -limit, 0.0, 1e-300, 0.5 * limit, std::nextafter(limit, 0.0), limit, std::nextafter(limit, 1.0),
      1.0,  2.5};
  for (const double a : awkward) {
    for (const double b : awkward) {
      for (const double c : awkward) samples.push_back({a, b, c});
    }
  }
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> stretch(-2, 3);
  for (int i = 0; i < 4000; ++i) samples.push_back({stretch(random), stretch(random), stretch(random)});
  return samples;
}

template <class Model>
class Materials : public testing::Test {};
using Models = testing::Types<RotatedLinear, NeoHookean, StVenantKirchhoff>;
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

/// ∮ P̂·dσ round a polygon through the compressed and inverted range. Its edges are split where they cross the
/// limit, so that P̂ is smooth on each piece and Gauss-Legendre panels integrate it to rounding.
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
    for (int i = 0; i < 3; ++i) breaks.push_back(std::clamp((limit_of(model) - from[i]) / step[i], 0.0, 1.0));
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

template <class Model>
void expect_clamped() {
  const auto model = make<Model>(Extension::clamp);
  const double limit = model.compression_limit;
  const Vec3d at_limit = model.principal_stress(Vec3d{1.2, limit, limit});
  const Vec3d beyond = model.principal_stress(Vec3d{1.2, -0.4, 0.0});
  EXPECT_EQ(at_limit, beyond);
  EXPECT_EQ(model.energy(Vec3d{1.2, limit, limit}), model.energy(Vec3d{1.2, -0.4, 0.0}));
}

TEST(Clamp, EvaluatesAtTheLimit) {
  expect_clamped<NeoHookean>();
  expect_clamped<StVenantKirchhoff>();
}

/// The formulas of PHYSICS 3, written once more as they stand there.
TEST(NeoHookean, IsTheTextbookFormAboveTheLimit) {
  const NeoHookean model{.lame = lame};
  const Vec3d sigma{1.7, 0.9, 0.45};
  const double log_j = std::log(sigma[0] * sigma[1] * sigma[2]);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(model.principal_stress(sigma)[i],
                lame.mu * sigma[i] + (lame.lambda * log_j - lame.mu) / sigma[i], 1e-12 * lame.lambda);
  }
}

TEST(StVenantKirchhoff, IsTheTextbookFormAboveTheLimit) {
  const StVenantKirchhoff model{.lame = lame};
  const Vec3d sigma{1.7, 0.9, 0.6};
  double trace = 0;
  for (int i = 0; i < 3; ++i) trace += (sigma[i] * sigma[i] - 1) / 2;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(model.principal_stress(sigma)[i],
                sigma[i] * (lame.mu * (sigma[i] * sigma[i] - 1) + lame.lambda * trace), 1e-12 * lame.lambda);
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

TEST(Lame, FromYoungAndPoisson) {
  const Lame steel = Lame::from_young_poisson(210e9, 0.3);
  EXPECT_NEAR(steel.mu, 210e9 / 2.6, 1e-3);
  EXPECT_NEAR(steel.lambda, 2 * steel.mu * 0.3 / 0.4, 1e-3);
}

}  // namespace
}  // namespace evert
