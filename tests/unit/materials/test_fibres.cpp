#include "evert/materials/material.hpp"
#include "evert/math/dual.hpp"

#include "models.hpp"
#include <algorithm>
#include <string>

/// Muscle and tendon at one point.
namespace evert {
namespace {

using namespace test;
using Real80 = long double;

template <class To, class From>
Mat3<To> converted(const Mat3<From>& a) {
  Mat3<To> b;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) b(i, j) = static_cast<To>(a(i, j));
  return b;
}
template <class To>
Vec3<To> converted(const Vec3d& a) {
  return {a[0], a[1], a[2]};
}

/// The matrix of PHYSICS 10, and one that hardly changes its volume.
constexpr std::array bulk_moduli{6e4, 6e5};

Muscle muscle(double activation, double bulk_modulus = bulk_moduli[0]) {
  const auto matrix = MooneyRivlin::from_constants(6e4, 2e4, bulk_modulus);
  return {.lame = matrix.lame, .share_01 = matrix.share_01, .activation = activation};
}
Tendon tendon(double bulk_modulus = bulk_moduli[0]) {
  const auto matrix = MooneyRivlin::from_constants(6e4, 2e4, bulk_modulus);
  return {.lame = matrix.lame, .share_01 = matrix.share_01};
}

/// Calls `check(model, name)` for muscle at several activations and for tendon.
template <class Check>
void for_each_model(Check&& check) {
  for (const double bulk : bulk_moduli) {
    for (const double activation : {0.0, 0.3, 1.0})
      check(muscle(activation, bulk), "muscle at activation " + std::to_string(activation));
    check(tendon(bulk), std::string("tendon"));
  }
}

/// What the models promise, by hand: no curves of theirs, branches instead of limits.
double tension(const Tendon& /*model*/, double stretch) {
  const auto curve = [](double s) { return 0.05 * (std::exp(6.6 * s) - 6.6 * s - 1); };
  const double s = stretch - 1;
  if (s <= 0) return 0;
  if (s <= 0.4) return 3e5 * curve(s);
  return 3e5 * (curve(0.4) + 0.05 * 6.6 * (std::exp(6.6 * 0.4) - 1) * (s - 0.4));
}
double tension(const Muscle& model, double stretch) {
  const double s = stretch - 1;
  const double active = std::abs(s) < 0.6 ? 1 - s * s / 0.36 : 0;
  return 3e5 * model.activation * active + tension(Tendon{}, stretch);
}

template <class Model>
Mat3d textbook(const Model& model, const Mat3d& f, const Vec3d& fibre) {
  const Vec3d now = f * fibre;
  return textbook_mooney_rivlin(model, f) + tension(model, norm(now)) / norm(now) * outer(now, fibre);
}

Vec3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vec3d any{normal(random), normal(random), normal(random)};
  return (1 / norm(any)) * any;
}

/// Where two stretches nearly cancel the axis of inversion is that of rounding.
template <class T>
bool axis_is_certain(const Svd3<T>& svd) {
  return svd.sigma[2] >= 0 || svd.sigma[1] + svd.sigma[2] > 1e-3;
}

/// What rounding is relative to: stresses, and the stiffness against the rounding of F.
template <class Model>
double scale_of(const Model& model, const Svd3<double>& svd, const Mat3d& p) {
  return norm(p) + (10 * model.lame.mu + model.peak_stress) * (1 + norm(svd.sigma)) +
         (norm(model.matrix().stress_derivative(svd.sigma)) + std::abs(model.fibre_stiffness(2.0))) *
             norm(svd.sigma);
}

TEST(Fibres, UniaxialStressAlongAndAcrossIsTheClosedForm) {
  std::mt19937_64 random(3);
  for_each_model([&](const auto& model, const std::string& name) {
    for (int i = 1; i < 200; ++i) {
      const double s = 0.26 + 0.01 * i;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3d fibre{};
        fibre[axis] = 1;
        const Mat3d f = diagonal<double>({s, 1, 1});
        const Mat3d turn = random_rotation(random);
        const Mat3d expected = textbook(model, f, fibre);
        const double tolerance = 1e-12 * (norm(expected) + model.lame.mu);
        EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(f), fibre) - expected), tolerance)
            << name << ' ' << s;
        EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(turn * f), fibre) - turn * expected), tolerance)
            << name << ' ' << s;
        const double along = expected(0, 0) - textbook_mooney_rivlin(model, f)(0, 0);
        EXPECT_NEAR(along, axis == 0 ? tension(model, s) : 0, tolerance) << name << ' ' << s;
      }
    }
  });
}

TEST(Fibres, StressInAnyDirectionIsTheClosedForm) {
  std::mt19937_64 random(4);
  for_each_model([&](const auto& model, const std::string& name) {
    int compared = 0;
    for (const Mat3d& f : random_gradients(2000)) {
      const auto svd = svd3(f);
      if (svd.sigma[2] < model.compression_limit) continue;
      const Vec3d fibre = random_direction(random);
      const Mat3d expected = textbook(model, f, fibre);
      EXPECT_LE(norm(first_piola_kirchhoff(model, svd, fibre) - expected),
                1e-12 * (norm(expected) + scale_of(model, svd, expected)))
          << name;
      ++compared;
    }
    EXPECT_GT(compared, 200);
  });
}

/// P is the gradient of the energy at random F, half of them inverted, by central differences.
TEST(Fibres, StressIsTheGradientOfTheEnergy) {
  std::mt19937_64 random(6);
  const Real80 h = 1e-7L;
  for_each_model([&](const auto& model, const std::string& name) {
    int inverted = 0;
    for (const Mat3d& f : random_gradients(2500)) {
      const auto svd = svd3(f);
      if (!axis_is_certain(svd)) continue;
      const Vec3d fibre = random_direction(random);
      const auto along = converted<Real80>(fibre);
      const Mat3d p = first_piola_kirchhoff(model, svd, fibre);
      const double scale = scale_of(model, svd, p);
      for (std::size_t entry = 0; entry < 9; ++entry) {
        auto forward = converted<Real80>(f), backward = forward;
        forward(entry / 3, entry % 3) += h;
        backward(entry / 3, entry % 3) -= h;
        const Real80 slope =
            (energy_density(model, svd3(forward), along) - energy_density(model, svd3(backward), along)) /
            (2 * h);
        EXPECT_NEAR(static_cast<double>(slope), p(entry / 3, entry % 3), 1e-7 * scale) << name;
      }
      inverted += svd.sigma[2] < 0 ? 1 : 0;
    }
    EXPECT_GT(inverted, 1000);
  });
}

TEST(Fibres, AreFrameIndifferentAndIsotropicAboutTheFibre) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> angle(0, 6.28);
  for_each_model([&](const auto& model, const std::string& name) {
    for (const Mat3d& f : random_gradients(2500)) {
      const auto svd = svd3(f);
      if (!axis_is_certain(svd)) continue;
      const Vec3d a = random_direction(random);
      const Mat3d p = first_piola_kirchhoff(model, svd, a);
      const double tolerance = 1e-12 * scale_of(model, svd, p) / std::min(1.0, svd.sigma[1] + svd.sigma[2]);
      const Mat3d turn = random_rotation(random);
      EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(turn * f), a) - turn * p), tolerance) << name;
      // Rodrigues: a rotation about the fibre.
      const double t = angle(random);
      const Mat3d cross_a{{{{0, a[2], -a[1]}, {-a[2], 0, a[0]}, {a[1], -a[0], 0}}}};
      const Mat3d about =
          std::cos(t) * identity<double>() + std::sin(t) * cross_a + (1 - std::cos(t)) * outer(a, a);
      EXPECT_LE(norm(first_piola_kirchhoff(model, svd3(f * about), a) - p * about), tolerance) << name;
      // The other way round it is the same fibre.
      EXPECT_LE(norm(first_piola_kirchhoff(model, svd, -a) - p), 1e-14 * norm(p)) << name;
    }
  });
}

/// P Fᵀ is symmetric: no torque from any state, inverted and flat ones included.
TEST(Fibres, KeepAngularMomentum) {
  std::mt19937_64 random(8);
  for_each_model([&](const auto& model, const std::string& name) {
    for (Mat3d f : random_gradients(2500)) {
      for (const bool flat : {false, true}) {
        if (flat) f.column[2] = f.column[0] - 0.5 * f.column[1];
        const auto svd = svd3(f);
        const Mat3d p = first_piola_kirchhoff(model, svd, random_direction(random));
        const Mat3d kirchhoff = times_transpose(p, f);
        EXPECT_LE(norm(kirchhoff - transpose(kirchhoff)), 1e-12 * scale_of(model, svd, p) * norm(f)) << name;
      }
    }
  });
}

/// Pushed through flat and inside out along one axis the element is pushed back, the more the further,
/// whatever the fibre's direction; the two others stretched by 0.2 to 3.
TEST(Fibres, StressBelowTheLimitRisesWithTheStretch) {
  const std::array<Vec3d, 5> fibres{{{0, 0, 1},
                                     {1, 0, 0},
                                     {0, 0.6, 0.8},
                                     {0.6, 0, 0.8},
                                     {1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}}};
  for_each_model([&](const auto& model, const std::string& name) {
    for (const Vec3d& fibre : fibres) {
      const auto stress = [&](double a, double b, double c) {
        const Svd3<double> svd{identity<double>(), {a, b, c}, identity<double>()};
        return model.along(fibre).stress_in_frames(svd)(2, 2);
      };
      for (double a = 0.2; a <= 3.05; a += 0.2) {
        for (double b = 0.2; b <= 3.05; b += 0.2) {
          double below = stress(a, b, -2);
          for (double c = -1.99; c < model.compression_limit; c += 0.01) {
            const double now = stress(a, b, c);
            EXPECT_GT(now, below) << name << ' ' << a << ' ' << b << ' ' << c;
            below = now;
          }
        }
      }
    }
  });
}

TEST(Fibres, HaveNoTensionWhereTheyAreShort) {
  const auto model = muscle(1);
  for (const double stretch : {0.0, 1e-300, 0.2, 0.4, 1.6})
    EXPECT_EQ(model.active.tension(stretch), 0) << stretch;
  for (const double stretch : {0.0, 1e-300, 0.4, 0.9999, 1.0}) EXPECT_EQ(tendon().fibre_tension(stretch), 0);
  EXPECT_DOUBLE_EQ(model.fibre_tension(1.0), 3e5);
  const Svd3<double> point{identity<double>(), {0, 0, 0}, identity<double>()};
  const Mat3d p = model.along(Vec3d{0, 0, 1}).stress_in_frames(point);
  EXPECT_EQ(p(2, 2), p(0, 0)) << "that of the matrix alone";
}

/// Tension is the slope of the energy, stiffness that of the tension, on both sides of every change.
TEST(Fibres, CurvesAreDerivativesOfEachOther) {
  using Number = Dual<double>;
  for_each_model([&](const auto& model, const std::string& name) {
    for (double stretch = 0.005; stretch < 3; stretch += 0.01) {
      const Number varied{stretch, 1};
      EXPECT_NEAR(model.fibre_energy(varied).derivative, model.fibre_tension(stretch),
                  1e-13 * (model.peak_stress + model.fibre_tension(stretch)))
          << name << ' ' << stretch;
      EXPECT_NEAR(model.fibre_tension(varied).derivative, model.fibre_stiffness(stretch),
                  1e-13 * (model.peak_stress + std::abs(model.fibre_stiffness(stretch))))
          << name << ' ' << stretch;
    }
    EXPECT_EQ(model.fibre_energy(1.0), 0);
  });
}

TEST(Fibres, PacksAgreeWithScalars) {
  std::mt19937_64 random(9);
  for_each_model([&](const auto& model, const std::string& name) {
    for (const Mat3d& f : random_gradients(500)) {
      const auto svd = svd3(f);
      const Vec3d a = random_direction(random);
      Svd3<Pack> packed;
      Vec3<Pack> fibre;
      for (std::size_t i = 0; i < 3; ++i) {
        packed.sigma[i] = Pack(svd.sigma[i]);
        fibre[i] = Pack(a[i]);
        for (std::size_t j = 0; j < 3; ++j) {
          packed.u(i, j) = Pack(svd.u(i, j));
          packed.v(i, j) = Pack(svd.v(i, j));
        }
      }
      const Mat3d p = model.along(a).stress_in_frames(svd);
      const Mat3<Pack> of_pack = model.along(fibre).stress_in_frames(packed);
      const double scale = scale_of(model, svd, p);
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(lane(of_pack(i / 3, i % 3), 1), p(i / 3, i % 3), 1e-14 * scale) << name;
      EXPECT_NEAR(lane(model.along(fibre).energy(packed), 1), model.along(a).energy(svd),
                  1e-14 * scale * (1 + norm(f)));
    }
  });
}

}  // namespace
}  // namespace evert
