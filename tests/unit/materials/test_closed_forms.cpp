#include "evert/materials/stress_measures.hpp"

#include "models.hpp"
#include <algorithm>
#include <string>

/// Every model above its limit against the formula of P(F) as publications have it: in invariants and
/// inverses, without principal stretches.
namespace evert {
namespace {

using namespace test;

/// A deformation whose rotation is known: F = R U.
struct Deformation {
  std::string name;
  Mat3d f;
  Mat3d rotation = identity<double>();
};

Mat3d inverse_transpose(const Mat3d& f) { return transpose(inverse(f)); }

/// Without invariants of F: the linear model of U.
Mat3d textbook(const RotatedLinear& model, const Deformation& at) {
  const Mat3d strain = transpose_times(at.rotation, at.f) - identity<double>();
  return at.rotation * (2 * model.lame.mu * strain + model.lame.lambda * trace(strain) * identity<double>());
}

/// Inside the limits.
Mat3d textbook(const Spline& model, const Deformation& at) {
  const Mat3d strain = transpose_times(at.rotation, at.f) - identity<double>();
  const double third = (model.elongation_stiffening - 1) / 3 / std::pow(model.elongation_limit - 1, 2);
  return at.rotation * (2 * model.lame.mu * (strain + third * (strain * (strain * strain))) +
                        model.lame.lambda * trace(strain) * identity<double>());
}

Mat3d textbook(const NeoHookean& model, const Deformation& at) {
  const double log_j = std::log(determinant(at.f));
  return model.lame.mu * at.f + (model.lame.lambda * log_j - model.lame.mu) * inverse_transpose(at.f);
}

/// By its second Piola-Kirchhoff stress.
Mat3d textbook(const StVenantKirchhoff& model, const Deformation& at) {
  const Mat3d e = 0.5 * (transpose_times(at.f, at.f) - identity<double>());
  return first_from_second_piola_kirchhoff(
      at.f, 2 * model.lame.mu * e + model.lame.lambda * trace(e) * identity<double>());
}

Mat3d textbook(const MooneyRivlin& model, const Deformation& at) {
  return textbook_mooney_rivlin(model, at.f);
}

/// Smith, de Goes, Kim 2018, eq. (13) and (18): ψ = μ/2 (I − 3) + λ/2 (J − α)² − μ/2 ln(I + 1).
Mat3d textbook(const StableNeoHookean& model, const Deformation& at) {
  const double mu = 4.0 / 3 * model.lame.mu;
  const double lambda = model.lame.lambda + 5.0 / 6 * model.lame.mu;
  const double alpha = 1 + mu / lambda - mu / (4 * lambda);
  return mu * (1 - 1 / (contract(at.f, at.f) + 1)) * at.f +
         lambda * (determinant(at.f) - alpha) * cofactor(at.f);
}

/// Where the formulas hold.
template <class Model>
std::pair<double, double> exact_range(const Model& model) {
  if constexpr (std::is_same_v<Model, Spline>) return {model.compression_limit, model.elongation_limit};
  if constexpr (has_extension<Model>) return {model.compression_limit, 4};
  return {0.01, 4};
}

Deformation simple_shear(double gamma) {
  Mat3d f = identity<double>(), r = identity<double>();
  f(0, 1) = gamma;
  const double length = std::hypot(2, gamma);
  r(0, 0) = r(1, 1) = 2 / length;
  r(0, 1) = gamma / length;
  r(1, 0) = -gamma / length;
  return {"simple shear", f, r};
}

/// Uniaxial, equibiaxial, simple shear and pure volume over the range.
std::vector<Deformation> paths(double low, double high) {
  std::vector<Deformation> all;
  for (int i = 1; i < 100; ++i) {
    const double s = low + (high - low) * i / 100;
    all.push_back({"uniaxial", diagonal<double>({s, 1, 1})});
    all.push_back({"equibiaxial", diagonal<double>({s, 1, s})});
    all.push_back({"volume", diagonal<double>({s, s, s})});
    all.push_back(simple_shear(std::min(1 / low - low, high - 1 / high) * (i - 50) / 50));
  }
  return all;
}

template <class Model>
class ClosedForms : public testing::Test {};
TYPED_TEST_SUITE(ClosedForms, Models);

TYPED_TEST(ClosedForms, AreReproduced) {
  const auto model = make<TypeParam>();
  const auto [low, high] = exact_range(model);
  std::mt19937_64 random(3);
  for (const auto& at : paths(low, high)) {
    const Mat3d turn = random_rotation(random);
    const Deformation turned{at.name, turn * at.f, turn * at.rotation};
    for (const auto& one : {at, turned}) {
      const Mat3d expected = textbook(model, one);
      EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(one.f)) - expected),
                1e-12 * (norm(expected) + model.lame.mu))
          << one.name << ' ' << one.f(0, 0) << ' ' << one.f(0, 1);
    }
  }
}

TEST(Spline, IsLinearBeyondItsLimits) {
  const Spline model{.lame = {0, 0.5},
                     .compression_limit = 0.4,
                     .elongation_limit = 1.7,
                     .compression_stiffening = 5,
                     .elongation_stiffening = 3};
  const auto stress = [&](double stretch) { return model.principal_stress(Vec3d{1, stretch, 1})[1]; };
  const double at_low = -0.6 * (1 + 4.0 / 3), at_high = 0.7 * (1 + 2.0 / 3);
  for (const double beyond : {0.0, 0.1, 0.4, 1.0, 2.4}) {
    EXPECT_NEAR(stress(0.4 - beyond), at_low - 5 * beyond, 1e-14);
    EXPECT_NEAR(stress(1.7 + beyond), at_high + 3 * beyond, 1e-14);
  }
}

TYPED_TEST(ClosedForms, AreFrameIndifferentAndIsotropic) {
  const auto model = make<TypeParam>();
  std::mt19937_64 random(7);
  for (const Mat3d& f : random_gradients(10000, true)) {
    const auto svd = svd3(f);
    // Where two stretches nearly cancel the axis of inversion is that of rounding.
    if (svd.sigma[2] < 0 && svd.sigma[1] + svd.sigma[2] < 1e-3) continue;
    const Mat3d p = first_piola_kirchhoff(model, svd);
    const double scale =
        norm(p) + 10 * model.lame.mu * (1 + norm(f)) + norm(model.stress_derivative(svd.sigma)) * norm(f);
    const double spin = svd.sigma[1] + svd.sigma[2];
    const double tolerance = 1e-12 * scale / std::min(1.0, spin);
    const Mat3d turn = random_rotation(random);
    EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(turn * f)) - turn * p), tolerance);
    EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(f * turn)) - p * turn), tolerance);
    const double energy = model.energy(svd.sigma);
    EXPECT_NEAR(model.energy(svd3(turn * f).sigma), energy, 1e-12 * scale * (1 + norm(f)));
    EXPECT_NEAR(model.energy(svd3(f * turn).sigma), energy, 1e-12 * scale * (1 + norm(f)));
  }
}

/// Small strains in every direction: P = 2με + λ tr ε to first order, by a difference of second order.
TYPED_TEST(ClosedForms, HaveTheModuliOfSmallStrains) {
  const auto model = make<TypeParam>();
  const double h = 1e-4;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      Mat3d gradient{};
      gradient(row, column) = h;
      const Mat3d slope = (0.5 / h) * (first_piola_kirchhoff(model, svd3(identity<double>() + gradient)) -
                                       first_piola_kirchhoff(model, svd3(identity<double>() - gradient)));
      const Mat3d strain = (0.5 / h) * (gradient + transpose(gradient));
      const Mat3d expected =
          2 * model.lame.mu * strain + model.lame.lambda * trace(strain) * identity<double>();
      EXPECT_LE(norm(slope - expected), 1e-6 * model.lame.lambda) << row << column;
    }
  }
}

}  // namespace
}  // namespace evert
