#pragma once
#include "evert/materials/material.hpp"
#include "evert/materials/stress_measures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

/// Every model with its defaults, and the stretches at which models are looked at.
namespace evert::test {

/// The models of `Variant` that are functions of the principal stretches alone, behind `Found`.
template <class Variant, class... Found>
struct IsotropicOf {
  using Types = testing::Types<Found...>;
};
template <class First, class... Rest, class... Found>
struct IsotropicOf<std::variant<First, Rest...>, Found...>
    : std::conditional_t<HasFibres<First>, IsotropicOf<std::variant<Rest...>, Found...>,
                         IsotropicOf<std::variant<Rest...>, Found..., First>> {};
/// A model joins every suite by joining the variant; those with fibres have theirs in test_fibres.cpp.
using Models = IsotropicOf<Material>::Types;

inline constexpr Lame firm = Lame::from_young_poisson(1e5, 0.4);

template <class Model>
inline constexpr bool has_extension = requires(const Model& model) {
  model.extension;
};

template <class Model>
Model make(Extension extension = Extension::linear) {
  Model model{};
  model.lame = firm;
  if constexpr (has_extension<Model>) model.extension = extension;
  return model;
}

/// Where the model is continued; 0.5 for models that have no such place.
template <class Model>
double limit_of(const Model& model) {
  if constexpr (requires { model.compression_limit; }) {
    return model.compression_limit;
  } else {
    return 0.5;
  }
}

/// Stretches where a derivative of the stress jumps.
template <class Model>
std::vector<double> kinks_of(const Model& model) {
  std::vector<double> kinks{limit_of(model)};
  if constexpr (requires { model.elongation_limit; }) kinks.insert(kinks.end(), {1, model.elongation_limit});
  return kinks;
}

/// Random stretches in [−2, 3], and every combination of the awkward ones: zero, the limit and its
/// neighbours, 1, repeated values.
inline std::vector<Vec3d> sample_stretches(double limit) {
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

/// A random rotation.
inline Mat3d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::array<double, 4> q{};
  double square = 0;
  for (double& x : q) {
    x = normal(random);
    square += x * x;
  }
  for (double& x : q) x /= std::sqrt(square);
  const auto [w, x, y, z] = q;
  return {{{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}}};
}

/// P of the Mooney-Rivlin model above its limit, also of one that is the matrix of fibres, by its Cauchy
/// stress: J σ = 2 dev(μ10 B̄ + μ01 (Ī1 B̄ − B̄²)) + κ ln J, B̄ = J^(−2/3) F Fᵀ.
template <class Model>
Mat3d textbook_mooney_rivlin(const Model& model, const Mat3d& f) {
  const double mu_01 = 0.5 * model.lame.mu * model.share_01, mu_10 = 0.5 * model.lame.mu - mu_01;
  const double j = determinant(f);
  const Mat3d b = std::pow(j, -2.0 / 3) * times_transpose(f, f);
  const Mat3d shape = mu_10 * b + mu_01 * (trace(b) * b - b * b);
  const Mat3d kirchhoff = 2.0 * (shape - trace(shape) / 3 * identity<double>()) +
                          model.lame.bulk_modulus() * std::log(j) * identity<double>();
  return first_piola_kirchhoff_from_cauchy(f, (1 / j) * kirchhoff);
}

/// Half of them inverted; one in ten flat if asked for.
inline std::vector<Mat3d> random_gradients(int count, bool some_flat = false) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> entry(-1.5, 1.5);
  std::vector<Mat3d> all;
  for (int i = 0; i < count; ++i) {
    Mat3d f;
    for (auto& column : f.column)
      for (double& x : column.components) x = entry(random);
    if ((determinant(f) < 0) != (i % 2 == 0)) f.column[0] = -f.column[0];
    if (some_flat && i % 10 == 0) f.column[2] = f.column[0] - 0.5 * f.column[1];
    all.push_back(f);
  }
  return all;
}

}  // namespace evert::test
