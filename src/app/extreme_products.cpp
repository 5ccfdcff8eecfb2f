#include "evert/core/formatted.hpp"

#include "extreme_scenes.hpp"

/// All materials with all elements, integrators and settings of the filter, some steps each.
namespace evert::extremes {
namespace {

struct Setting {
  const char* name;
  const char* text;
};
constexpr std::array<Setting, 5> filters{
    {{"no filter", ""},
     {"compliant", "filter: {time_step: 0.05}"},
     {"alone", "filter: {time_step: 0.05, constraints: none}"},
     {"paper", "filter: {time_step: 0.05, selection: paper, constraints: paper}"},
     {"adaptive", "filter: {time_step: 0.05, selection: adaptive}"}}};
/// The explicit ones with the damping that makes explicit Euler stable.
constexpr std::array<Setting, 5> methods{
    {{"newmark", "integrator: {method: newmark}"},
     {"verlet", "integrator: {method: verlet}"},
     {"symplectic_euler", "integrator: {method: symplectic_euler, safety: 0.5}"},
     {"explicit_euler", "integrator: {method: explicit_euler, time_step: 5e-4}"},
     {"quasistatic",
      "integrator: {method: quasistatic}\nconstraints:\n  - {body: body, node_set: x_min, fixed: true}"}}};

}  // namespace

void add_products(std::vector<ExtremeCase>& cases) {
  for (const auto& [method, integrator] : methods)
    for (const auto& model : all_models())
      for (const auto& element : all_elements)
        for (const auto& [filter, keys] : filters) {
          auto parts = box_of(element, "[2, 1, 1]");
          parts.material = model.text;
          parts.body.emplace_back(model.body);
          parts.body.emplace_back("start: {kind: flatten_plane, amplitude: 0.1, axis: [1, 2, 3]}");
          parts.body.emplace_back("damping: {model: blended, stiffness_proportional: 1e-3}");
          parts.world.emplace_back(integrator);
          if (*keys != '\0') parts.world.emplace_back(keys);
          cases.push_back({.family = std::string("everything with ") + method,
                           .row = std::string(model.name) + " " + element.name,
                           .column = filter,
                           .scene = scene_of(parts),
                           .most_steps = 50});
        }
}

}  // namespace evert::extremes
