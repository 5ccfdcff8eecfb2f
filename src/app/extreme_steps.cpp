#include "evert/core/formatted.hpp"

#include "extreme_scenes.hpp"
#include <algorithm>

/// Fixed steps from far below the true limit to far above it.
namespace evert::extremes {
namespace {

constexpr std::array<double, 15> shares{0.01, 0.1, 0.5, 0.9, 0.99, 1.01, 1.05, 1.2,
                                        1.5,  2,   3,   5,   10,   30,   100};

/// Of the largest energy, what a scheme may show as gained. At the share s of the limit Verlet's and
/// Newmark's keep v²/2 + (1 − s²) ω²x²/2 of a vibration, symplectic Euler v²/2 + ω²x²/2 − s ω v x.
double ripple_of(const std::string& method, double share) {
  constexpr double least = 0.2;
  return std::max(least, method == "symplectic_euler" ? 2 * share / (1 + share) : share * share);
}

/// Near the limit it matters how far a body is deformed: some get stiffer, others softer, which holds the
/// growth.
Promise promise_of(double share) {
  constexpr double near = 0.02;
  return share > 1 + near ? Promise::detection : share > 1 - near ? Promise::any : Promise::stability;
}

/// A body that rings a little, without damping.
void add(std::vector<ExtremeCase>& cases, const std::string& family, const std::string& column,
         SceneParts parts, const std::string& method) {
  parts.end_time = 1e4;  // [s] the steps end the run
  parts.body.emplace_back("start: {kind: scramble, amplitude: 1e-3}");
  parts.world.push_back("integrator: {method: " + method + "}");
  for (const double share : shares)
    cases.push_back({.family = family,
                     .row = short_number(share) + " x",
                     .column = column,
                     .scene = scene_of(parts),
                     .promise = promise_of(share),
                     .most_steps = 1000,
                     .energy_gain = ripple_of(method, share),
                     .step_over_limit = share});
}

}  // namespace

void add_steps(std::vector<ExtremeCase>& cases) {
  for (const auto& element : all_elements)
    for (const char* method : {"newmark", "verlet", "symplectic_euler"}) {
      auto parts = box_of(element, "[4, 2, 2]");
      parts.material = "{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.4}";
      add(cases, "step over the limit, by element", std::string(element.name) + " " + method, parts, method);
    }
  for (const auto& model : all_models()) {
    SceneParts parts;
    parts.material = model.text;
    parts.body.emplace_back(model.body);
    add(cases, "step over the limit, by material", model.name, parts, "verlet");
  }
}

}  // namespace evert::extremes
