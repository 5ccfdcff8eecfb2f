#include "evert/materials/stress_measures.hpp"
#include "evert/materials/tangent.hpp"

#include <Eigen/Eigenvalues>

#include "models.hpp"
#include <algorithm>

/// ∂P/∂F of every model against differences of P.
namespace evert {
namespace {

using namespace test;
using Real80 = long double;

Mat3<Real80> in_long_double(const Mat3d& a) {
  Mat3<Real80> b;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) b(i, j) = a(i, j);
  return b;
}
Mat3d in_double(const Mat3<Real80>& a) {
  Mat3d b;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) b(i, j) = static_cast<double>(a(i, j));
  return b;
}

template <class Model>
Mat3<Real80> stress(const Model& model, const Mat3<Real80>& f) {
  return first_piola_kirchhoff(model, svd3(f));
}

constexpr Real80 step = 1e-7L;

/// (P(F + h dF) − P(F − h dF)) / 2h
template <class Model>
Mat3d central_difference(const Model& model, const Mat3d& f, const Mat3d& df) {
  const Mat3<Real80> at = in_long_double(f), change = step * in_long_double(df);
  return in_double((0.5L / step) * (stress(model, at + change) - stress(model, at - change)));
}

/// The same from points on one side only, of second order.
template <class Model>
Mat3d forward_difference(const Model& model, const Mat3d& f, const Mat3d& df) {
  const Mat3<Real80> at = in_long_double(f), change = step * in_long_double(df);
  return in_double((0.5L / step) * (4.0L * stress(model, at + change) - stress(model, at + 2.0L * change) -
                                    3.0L * stress(model, at)));
}

Mat3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Mat3d df;
  for (auto& column : df.column)
    for (double& x : column.components) x = normal(random);
  return (1 / norm(df)) * df;
}

template <class Model>
double tangent_scale(const Model& model, const PrincipalTangent<double>& tangent) {
  return norm(tangent.stretch) + norm(tangent.shear) + norm(tangent.spin) + model.lame.mu;
}

/// P jumps where the axis of inversion switches, in all models but those that are smooth in F.
template <class Model>
bool is_smooth_at(const Vec3d& sigma) {
  return HasSpinModuli<Model> || sigma[1] + sigma[2] > 1e-3;
}

/// No kink of the model within reach of the differences.
template <class Model>
bool is_away_from_kinks(const Model& model, const Vec3d& sigma) {
  for (const double kink : kinks_of(model))
    for (const double s : sigma.components)
      if (std::abs(s - kink) < 1e-6) return false;
  return true;
}

template <class Model>
void expect_derivative(const Model& model, const Mat3d& f, const Mat3d& df, double tolerance = 1e-9) {
  const auto svd = svd3(f);
  const auto tangent = principal_tangent(model, svd.sigma);
  EXPECT_LE(norm(stress_change(tangent, svd, df) - central_difference(model, f, df)),
            tolerance * tangent_scale(model, tangent))
      << svd.sigma[0] << ' ' << svd.sigma[1] << ' ' << svd.sigma[2];
}

template <class Model>
class Tangents : public testing::Test {};
TYPED_TEST_SUITE(Tangents, Models);

TYPED_TEST(Tangents, AreDerivativesAtRandomF) {
  const auto model = make<TypeParam>();
  std::mt19937_64 random(17);
  int inverted = 0, tested = 0;
  for (const Mat3d& f : random_gradients(10000)) {
    const Vec3d sigma = svd3(f).sigma;
    if (!is_smooth_at<TypeParam>(sigma) || !is_away_from_kinks(model, sigma)) continue;
    ++tested;
    inverted += sigma[2] < 0 ? 1 : 0;
    expect_derivative(model, f, random_direction(random), 1e-7);
  }
  EXPECT_GT(tested, 9900);
  EXPECT_GT(inverted, 4900);
}

/// Stretches that are equal, nearly equal, zero, opposite: in every frame, in every direction.
TYPED_TEST(Tangents, AreDerivativesAtRepeatedAndZeroStretches) {
  const auto model = make<TypeParam>();
  std::mt19937_64 random(19);
  std::vector<Vec3d> stretches;
  for (const double gap : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-4}) {
    for (const double s : {1.0, 1.3, 0.7, 0.2, 2.0}) {
      stretches.push_back({s + gap, s, s - gap});
      stretches.push_back({2.1, s + gap, s});
      stretches.push_back({s + gap, s, 0});
      stretches.push_back({s + gap, s, -0.1});
      stretches.push_back({s, 0.15 + gap, 0.15});
      stretches.push_back({s, 0.15, gap});
      stretches.push_back({s, 0.15, -gap});
      stretches.push_back({s, gap, gap});
      stretches.push_back({s, s + gap, -s});
    }
  }
  stretches.push_back({0, 0, 0});
  for (const Vec3d& sigma : stretches) {
    const Mat3d f = random_rotation(random) * diagonal(sigma) * random_rotation(random);
    const Vec3d sorted = svd3(f).sigma;
    if (!is_smooth_at<TypeParam>(sorted) || !is_away_from_kinks(model, sorted)) continue;
    for (int i = 0; i < 10; ++i) expect_derivative(model, f, random_direction(random));
  }
}

/// At the limit, and with a pair on both sides of it or on it, as near as numbers get: against the side that
/// the model takes, in a diagonal frame so that rounding does not choose the side.
TYPED_TEST(Tangents, AreOneSidedDerivativesAtTheLimit) {
  const auto model = make<TypeParam>();
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> entry(0, 1);
  for (const double kink : kinks_of(model)) {
    for (const Vec3d& sigma : {Vec3d{2, 1.2, kink}, Vec3d{2, kink, 0.1}, Vec3d{kink, 0.2, 0.1},
                               Vec3d{kink, 0.2, -0.1}, Vec3d{2, 1, kink}}) {
      for (int i = 0; i < 20; ++i) {
        // No change that would move a stretch below the limit: growing along the axes, and shear of the
        // others.
        const Mat3d df = diagonal<double>({entry(random), entry(random), entry(random)});
        Svd3<double> svd{identity<double>(), sigma, identity<double>()};
        const auto tangent = principal_tangent(model, sigma);
        EXPECT_LE(norm(stress_change(tangent, svd, df) - forward_difference(model, diagonal(sigma), df)),
                  1e-7 * tangent_scale(model, tangent))
            << sigma[0] << ' ' << sigma[1] << ' ' << sigma[2];
      }
    }
  }
}

/// The moduli of pairs against quotients in long double, with one stretch on either side of a kink or on it.
TYPED_TEST(Tangents, ShearModuliAreDividedDifferencesAcrossTheLimit) {
  for (const Extension extension : {Extension::linear, Extension::clamp}) {
    const auto model = make<TypeParam>(extension);
    for (const double kink : kinks_of(model)) {
      for (const double gap : {1e-2, 1e-4, 1e-6, 1e-8}) {
        for (const double where : {-1.0, -0.7, -0.2, 0.0}) {
          const Vec3d sigma{kink + (where + 1) * gap, kink + where * gap, 0.9};
          const Vec3<Real80> exact{sigma[0], sigma[1], sigma[2]};
          const Vec3<Real80> stress = model.principal_stress(exact);
          const auto quotient = static_cast<double>((stress[0] - stress[1]) / (exact[0] - exact[1]));
          const double shear = principal_tangent(model, sigma).shear[2];
          EXPECT_NEAR(shear, quotient, 1e-10 * (std::abs(quotient) + model.lame.mu)) << gap << ' ' << where;
        }
      }
    }
  }
}

/// Of a model that offers no moduli of its own.
struct Plain {
  NeoHookean model{.lame = firm};
  template <class T>
  Vec3<T> principal_stress(const Vec3<T>& sigma) const {
    return model.principal_stress(sigma);
  }
  template <class T>
  Mat3<T> stress_derivative(const Vec3<T>& sigma) const {
    return model.stress_derivative(sigma);
  }
};

TEST(PairModuli, OfAModelWithoutItsOwnAreNearlyAsGood) {
  static_assert(!HasShearModuli<Plain> && !HasSpinModuli<Plain>);
  const Plain plain;
  for (const double gap : {0.0, 1e-15, 1e-9, 1e-7, 9e-6, 1.1e-5, 1e-3, 0.1}) {
    const Vec3d sigma{1.2, 0.8 + gap, 0.8};
    EXPECT_NEAR(principal_tangent(plain, sigma).shear[0], principal_tangent(plain.model, sigma).shear[0],
                1e-9 * firm.lambda)
        << gap;
  }
}

using Matrix9 = Eigen::Matrix<double, 9, 9>;

Matrix9 matrix_of(const PrincipalTangent<double>& tangent, const Svd3<double>& svd) {
  const auto entries = tangent_matrix(tangent, svd);
  Matrix9 matrix;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = entries[i][j];
  return matrix;
}

/// The nearest positive semidefinite matrix is that of the positive eigenvalues.
TYPED_TEST(Tangents, ProjectToTheNearestPositiveSemidefinite) {
  const auto model = make<TypeParam>();
  std::mt19937_64 random(29);
  std::uniform_real_distribution<double> stretch(0, 2);
  int indefinite = 0;
  for (int i = 0; i < 300; ++i) {
    const Mat3d f = random_rotation(random) *
                    diagonal<double>({stretch(random), stretch(random), stretch(random) - 1}) *
                    random_rotation(random);
    const auto svd = svd3(f);
    const auto tangent = principal_tangent(model, svd.sigma);
    const Matrix9 whole = matrix_of(tangent, svd);
    EXPECT_LE((whole - whole.transpose()).norm(), 1e-13 * whole.norm());
    const Eigen::SelfAdjointEigenSolver<Matrix9> eigen(whole);
    const Matrix9 nearest = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
                            eigen.eigenvectors().transpose();
    EXPECT_LE((matrix_of(positive_part(tangent), svd) - nearest).norm(), 1e-12 * whole.norm());
    indefinite += eigen.eigenvalues().minCoeff() < -1e-3 * model.lame.mu ? 1 : 0;
  }
  EXPECT_GT(indefinite, 30);
}

TYPED_TEST(Tangents, AreFiniteAtWorst) {
  const auto model = make<TypeParam>();
  for (const Vec3d& sigma : {Vec3d{0.0, 0.0, 0.0}, Vec3d{1, 1, -1}, Vec3d{1, 0, 0}, Vec3d{1e100, 1e-100, 0},
                             Vec3d{1e-300, 1e-300, -1e-300}}) {
    const auto tangent = positive_part(principal_tangent(model, sigma));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(std::isfinite(tangent.shear[k]) && std::isfinite(tangent.spin[k]) &&
                  std::isfinite(tangent.stretch(k, k)))
          << sigma[0] << ' ' << sigma[1] << ' ' << sigma[2];
  }
}

TYPED_TEST(Tangents, OfPacksAgreeWithScalars) {
  const auto model = make<TypeParam>();
  for (const Vec3d& sigma : sample_stretches(limit_of(model))) {
    if (sigma[0] + sigma[1] < 1e-3 || sigma[0] + sigma[2] < 1e-3 || sigma[1] + sigma[2] < 1e-3) continue;
    const auto scalar = principal_tangent(model, sigma);
    const auto packed = principal_tangent(model, Vec3<Pack>{Pack(sigma[0]), Pack(sigma[1]), Pack(sigma[2])});
    const double scale = tangent_scale(model, scalar) * (1 + norm(sigma)) * (1 + norm(sigma));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(lane(packed.shear[k], 0), scalar.shear[k], 1e-13 * scale);
      EXPECT_NEAR(lane(packed.spin[k], 0), scalar.spin[k], 1e-13 * scale);
    }
  }
}

}  // namespace
}  // namespace evert
