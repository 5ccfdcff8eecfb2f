#include "extreme_scenes.hpp"
#include <cmath>

/// Bodies whose nodes start anywhere but where they belong.
namespace evert::extremes {
namespace {

/// docs/recovery.md promises these; the way of a scrambled rotated_linear body is chaotic.
bool must_recover(const std::string& model, const std::string& kind) {
  if (model == "rotated_linear") return kind != "scramble";
  return model == "neo_hookean" || model == "st_venant_kirchhoff";
}

SceneParts ball_of(const Model& model) {
  SceneParts parts;
  parts.material = model.text;
  parts.body.emplace_back(model.body);
  return parts;
}

void add_models(std::vector<ExtremeCase>& cases) {
  for (const auto& model : all_models())
    for (const char* kind : start_kinds)
      cases.push_back({.family = "starts by material",
                       .row = model.name,
                       .column = kind,
                       .scene = scene_of(settling_from(start_of(kind), ball_of(model))),
                       .promise = must_recover(model.name, kind) ? Promise::recovery : Promise::any});
}

void add_elements(std::vector<ExtremeCase>& cases) {
  for (const auto& element : all_elements)
    for (const char* kind : start_kinds) {
      auto parts = box_of(element, "[4, 2, 2]");
      parts.material = model_of("neo_hookean").text;
      cases.push_back({.family = "starts by element",
                       .row = element.name,
                       .column = kind,
                       .scene = scene_of(settling_from(start_of(kind), parts, {.spin = 3, .longer = 1.3})),
                       .promise = std::string(element.name) == "tet4" ? Promise::recovery : Promise::any});
    }
}

/// As tests/extremes/test_filtered_recovery.cpp.
void add_filtered(std::vector<ExtremeCase>& cases) {
  struct Filter {
    const char* name;
    const char* keys;
  };
  for (const auto& [name, keys] : {Filter{"compliant", ""}, Filter{"filter alone", ", constraints: none"},
                                   Filter{"adaptive", ", selection: adaptive"}})
    for (const char* kind : start_kinds) {
      auto parts = ball_of(model_of("neo_hookean"));
      parts.world.push_back(std::string("filter: {time_step: 6.5e-3") + keys + "}");
      cases.push_back({.family = "starts with a filter",
                       .row = name,
                       .column = kind,
                       .scene = scene_of(settling_from(start_of(kind), parts, {.spin = 3, .longer = 1.3})),
                       .promise = Promise::recovery});
    }
}

/// Stresses of st_venant_kirchhoff grow with the cube of the stretch: a thousand times the size they are
/// faster than light.
void add_far_scrambles(std::vector<ExtremeCase>& cases) {
  constexpr double far = 1000;
  for (const char* model : {"neo_hookean", "st_venant_kirchhoff", "rotated_linear"})
    for (const double size : {1.0, 10.0, far}) {
      const bool flies = size == far && std::string(model) == "st_venant_kirchhoff";
      cases.push_back({.family = "scrambles by size",
                       .row = model,
                       .column = short_number(size) + " x",
                       .scene = scene_of(settling_from(start_of("scramble", size), ball_of(model_of(model)),
                                                       {.spin = 3, .longer = 1.3, .contract = 1})),
                       .promise = flies ? Promise::any : Promise::recovery});
    }
}

void add_single(std::vector<ExtremeCase>& cases, int ranks) {
  const auto file = std::pair<std::string, std::string>{"mesh.msh", tetrahedra_in_a_row(1)};
  const auto add = [&](const char* row, const char* kind, SceneParts parts,
                       std::vector<std::pair<std::string, std::string>> files) {
    parts.material = model_of("neo_hookean").text;
    cases.push_back({.family = "one element",
                     .row = row,
                     .column = kind,
                     .scene = scene_of(settling_from(start_of(kind), parts, {.spin = 3, .longer = 1.3})),
                     .files = std::move(files)});
  };
  for (const char* kind : start_kinds) {
    for (const int order : {1, 2}) {
      SceneParts parts;
      parts.mesh = "{file: mesh.msh}";
      if (order == 2) parts.body.emplace_back("order: 2");
      add(order == 2 ? "tet10" : "tet4", kind, parts, {file});
    }
    add("hex8", kind, box_of(all_elements[1], "[1, 1, 1]"), {});
    add("two wedge6", kind, box_of(all_elements[2], "[1, 1, 1]"), {});
    SceneParts parts;
    parts.mesh = "{file: mesh.msh}";
    add("one tet4 a rank", kind, parts, {{"mesh.msh", tetrahedra_in_a_row(ranks)}});
  }
}

}  // namespace

void add_starts(std::vector<ExtremeCase>& cases, int ranks) {
  add_models(cases);
  add_elements(cases);
  add_filtered(cases);
  add_far_scrambles(cases);
  add_single(cases, ranks);
}

}  // namespace evert::extremes
