#pragma once
#include "evert/math/svd3.hpp"

#include "bodies.hpp"

/// Paper A, sections 3-5, once more in long double: dense, per cell, by its printed formulas.
namespace evert::test {

using Real80 = long double;

struct ReferenceForces {
  std::vector<Vec3<Real80>> forces;
  /// Σ V ‖P‖ ‖g‖ per node.
  std::vector<Real80> magnitude;
  /// Σ V (‖P‖ + 2μ + 3λ) ‖g‖ per node: what rounding of F, by parts of 1, is relative to.
  std::vector<Real80> stiffness;
  Real80 energy = 0;
};

template <class To, class From>
Vec3<To> converted(const Vec3<From>& v) {
  return {static_cast<To>(v[0]), static_cast<To>(v[1]), static_cast<To>(v[2])};
}

inline ReferenceForces reference_forces(const Body& body, const Material& material, const NodalValues& x) {
  ReferenceForces result;
  result.forces.resize(body.rest.size(), {0, 0, 0});
  result.magnitude.resize(body.rest.size(), 0);
  result.stiffness.resize(body.rest.size(), 0);
  const Lame lame = std::visit([](const auto& model) { return model.lame; }, material);
  with_reference_element(body.type, [&]<int nodes, int points>(
                                        const ReferenceElement<nodes, points>& element) {
    for (LocalIndex c = 0; c < body.cells(); ++c) {
      const auto cell = body.cell(c);
      for (std::size_t q = 0; q < points; ++q) {
        Mat3<Real80> rest{}, now{};
        for (std::size_t a = 0; a < nodes; ++a) {
          const auto gradient = converted<Real80>(element.gradients[q][a]);
          const auto node = static_cast<std::size_t>(cell[a]);
          rest += outer(converted<Real80>(body.rest[node]), gradient);
          now += outer(converted<Real80>(at_node(x, node)), gradient);
        }
        const Mat3<Real80> inverse_rest = inverse(rest);
        const Real80 volume = determinant(rest) * element.weights[q];
        const auto [u, sigma, v] = svd3(now * inverse_rest);
        const auto fibre = converted<Real80>(body.fibres[static_cast<std::size_t>(c)]);
        const auto [p, energy] = std::visit(
            [&, svd = Svd3<Real80>{u, sigma, v}](const auto& model) {
              return std::pair{first_piola_kirchhoff(model, svd, fibre), energy_density(model, svd, fibre)};
            },
            material);
        result.energy += volume * energy;
        for (std::size_t a = 0; a < nodes; ++a) {
          const auto node = static_cast<std::size_t>(cell[a]);
          const Vec3<Real80> gradient =
              transpose_times(inverse_rest, converted<Real80>(element.gradients[q][a]));
          result.forces[node] -= volume * (p * gradient);
          result.magnitude[node] += volume * norm(p) * norm(gradient);
          result.stiffness[node] += volume * (norm(p) + 2 * lame.mu + 3 * lame.lambda) * norm(gradient);
        }
      }
    }
  });
  return result;
}

/// The largest error of a component relative to the magnitude at its node; infinite when not finite.
inline double relative_error(const NodalValues& f, const ReferenceForces& reference) {
  Real80 worst = 0;
  for (std::size_t node = 0; node < reference.forces.size(); ++node) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Real80 error = std::abs(f[3 * node + i] - reference.forces[node][i]);
      if (!std::isfinite(error)) return std::numeric_limits<double>::infinity();
      if (error > 0) worst = std::max(worst, error / reference.magnitude[node]);
    }
  }
  return static_cast<double>(worst);
}

}  // namespace evert::test
