#include "evert/core/formatted.hpp"

#include "extreme_scenes.hpp"
#include <cmath>

/// Bodies of normal shape in numbers that are anything but.
namespace evert::extremes {
namespace {

constexpr std::int64_t some_steps = 300;
constexpr double long_enough = 1e5;  // [s] the steps end the run

/// Of a body of this size [m], density [kg/m³] and 1e5 Pa, in that of 1 m and 1000 kg/m³.
double time_unit(double size, double density) { return size * std::sqrt(density / 1000); }

/// Squeezed by a share of its length, and let go.
SceneParts released(SceneParts parts, double share, double axis_of_box = 0) {
  parts.end_time = long_enough;
  parts.body.push_back("start: {kind: flatten_plane, amplitude: " + formatted("%g", share) +
                       (axis_of_box > 0 ? ", axis: [1, 0, 0]}" : ", axis: [1, 2, 3]}"));
  return parts;
}

void add_sizes(std::vector<ExtremeCase>& cases) {
  for (const double size : {1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9})
    for (const char* kind : start_kinds) {
      SceneParts parts;
      parts.material = model_of("neo_hookean").text;
      parts.body.push_back(formatted("transform: {scale: %g}", size));
      cases.push_back(
          {.family = "sizes",
           .row = short_number(size) + " m",
           .column = kind,
           .scene = scene_of(settling_from(start_of(kind), parts, {.time = time_unit(size, 1000)})),
           .promise = Promise::recovery});
    }
}

void add_densities(std::vector<ExtremeCase>& cases) {
  for (const double density : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const char* kind : start_kinds) {
      SceneParts parts;
      parts.material = model_of("neo_hookean").text;
      parts.density = density;
      cases.push_back(
          {.family = "densities",
           .row = short_number(density) + " kg per m^3",
           .column = kind,
           .scene = scene_of(settling_from(start_of(kind), parts, {.time = time_unit(1, density)})),
           .promise = Promise::recovery});
    }
}

void add_poissons_ratios(std::vector<ExtremeCase>& cases) {
  for (const double ratio : {-0.9, 0.0, 0.3, 0.45, 0.49, 0.499, 0.4999})
    for (const auto& element : all_elements)
      for (const char* model : {"neo_hookean", "rotated_linear"}) {
        auto parts = box_of(element, "[4, 2, 2]");
        parts.material =
            std::string("{model: ") + model + formatted(", youngs_modulus: 1e5, poissons_ratio: %g}", ratio);
        cases.push_back({.family = "poissons ratio",
                         .row = short_number(ratio),
                         .column = std::string(element.name) + " " + model,
                         .scene = scene_of(released(parts, 0.2)),
                         .promise = Promise::stability,
                         .most_steps = some_steps});
      }
}

void add_aspect_ratios(std::vector<ExtremeCase>& cases) {
  for (const double aspect : {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    const auto add = [&](const std::string& column, SceneParts parts, Promise promise) {
      cases.push_back({.family = "aspect ratio",
                       .row = short_number(aspect),
                       .column = column,
                       .scene = scene_of(std::move(parts)),
                       .promise = promise,
                       .most_steps = some_steps});
    };
    const auto flat = [&](const Element& element) {
      auto parts = box_of(element, "[3, 3, 2]");
      parts.mesh = formatted("{generate: box, size: [3, 3, %.17g], cells: [3, 3, 2], cell: %s}", 2 / aspect,
                             element.cell);
      return parts;
    };
    for (const auto& element : all_elements)
      add(element.name, released(flat(element), 0.1), Promise::stability);
    SceneParts wedges;
    wedges.mesh = formatted("{generate: wedge_stack, edge_ratio: %.17g}", aspect);
    add("wedge stack", released(wedges, 0.1), Promise::stability);
    auto thrown = flat(all_elements[0]);
    thrown.end_time = long_enough;
    thrown.body.push_back("start: " + start_of("inside_out"));
    add("tet4 inside out", thrown, Promise::any);
  }
}

void add_contrasts(std::vector<ExtremeCase>& cases) {
  const auto add = [&](double contrast, const std::string& column, bool tetrahedra, const char* keys,
                       Promise promise) {
    SceneParts parts;
    parts.mesh = "{file: mesh.msh}";
    parts.material = "{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.4}";
    parts.body.push_back(
        formatted("groups: {soft: {}, stiff: {material: {model: neo_hookean, youngs_modulus: %g, "
                  "poissons_ratio: 0.4}}}",
                  1e5 * contrast));
    parts.world.emplace_back(keys);
    cases.push_back({.family = "stiffness of neighbours",
                     .row = short_number(contrast) + " to 1",
                     .column = column,
                     .scene = scene_of(released(parts, 0.1)),
                     .promise = promise,
                     .most_steps = some_steps,
                     .files = {{"mesh.msh", soft_and_stiff(tetrahedra)}}});
  };
  for (const double contrast : {1.0, 1e2, 1e4, 1e6, 1e8}) {
    for (const bool tetrahedra : {true, false})
      for (const std::string method : {"newmark", "verlet"})
        add(contrast, (tetrahedra ? "tet4 " : "hex8 ") + method, tetrahedra,
            ("integrator: {method: " + method + "}").c_str(), Promise::stability);
    add(contrast, "tet4 filtered", true, "filter: {time_step: 1e-2}", Promise::any);
  }
}

void add_gravity(std::vector<ExtremeCase>& cases) {
  for (const double gravity : {10.0, 1e3, 1e6})
    for (const char* model : {"neo_hookean", "rotated_linear", "stable_neo_hookean"})
      for (const char* method : {"newmark", "verlet", "symplectic_euler"}) {
        SceneParts parts;
        parts.end_time = 0.2;
        parts.material = model_of(model).text;
        parts.body = {"transform: {translate: [0, 0.6, 0]}",
                      "damping: {model: rotated, stiffness_proportional: 1e-3}"};
        parts.world = {formatted("gravity: [0, %g, 0]", -gravity),
                       "obstacles:\n  ground: {shape: half_space, normal: [0, 1, 0], friction: 0.3}",
                       std::string("integrator: {method: ") + method + "}"};
        cases.push_back({.family = "gravity",
                         .row = short_number(gravity) + " m per s^2",
                         .column = std::string(model) + " " + method,
                         .scene = scene_of(parts),
                         .promise = Promise::stability,
                         .most_steps = 2000});
      }
}

/// A million steps in which nothing may move.
void add_rest(std::vector<ExtremeCase>& cases) {
  for (const char* method : {"newmark", "verlet", "symplectic_euler"}) {
    auto parts = box_of(all_elements[1], "[1, 1, 1]");
    parts.end_time = long_enough;
    parts.world = {std::string("integrator: {time_step: 1e-3, method: ") + method + "}"};
    cases.push_back({.family = "a million steps at rest",
                     .row = "hex8",
                     .column = method,
                     .scene = scene_of(parts),
                     .promise = Promise::recovery,
                     .most_steps = 1000000,
                     .ends_recovered = false});
  }
}

}  // namespace

void add_numbers(std::vector<ExtremeCase>& cases) {
  add_sizes(cases);
  add_densities(cases);
  add_poissons_ratios(cases);
  add_aspect_ratios(cases);
  add_contrasts(cases);
  add_gravity(cases);
  add_rest(cases);
}

}  // namespace evert::extremes
