#include "case.hpp"

/// Cases of muscle and tendon: where fibres run, and how active they are.
namespace evert::cli {
namespace {

const std::string isotropic = "model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3";

/// The good scene with this material and these lines of its body.
std::vector<Edit> edits(const std::string& material, const std::vector<std::string>& lines) {
  std::string all = "    damping:";
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) all = "    " + *line + "\n" + all;
  return {{isotropic, material}, {"    damping:", all}};
}

const std::string muscle = "model: muscle, youngs_modulus: 1e5, poissons_ratio: 0.3";
const std::string tendon = "model: tendon, mu_10: 6e4, mu_01: 2e4, bulk_modulus: 6e5";
const std::string along_x = "fibres: {direction: [1, 0, 0]}";
const std::string by_field = "fibres: {field: fibres}";

Case good_scene(const std::string& name, const std::vector<Edit>& changes) {
  return {.name = name, .files = {scene(changes)}, .exit_code = 0};
}

Case bad_scene(const std::string& name, const std::string& material, const std::vector<std::string>& lines,
               const std::vector<std::string>& says) {
  return {.name = name, .files = {scene(edits(material, lines))}, .says = says};
}

/// The good scene as muscle whose mesh file is `mesh`, which must have the field that `lines` name.
File scene_with_field(const std::string& mesh, const std::vector<std::string>& lines) {
  auto all = edits(muscle, lines);
  all.emplace_back("generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: tet6", "file: " + mesh);
  return scene(all);
}

Case bad_field(const std::string& name, const File& mesh, const std::vector<std::string>& says) {
  return {.name = name, .files = {scene_with_field(mesh.path, {by_field}), mesh}, .says = says};
}

/// $ElementData of the six tetrahedra; `rows` are numbers of elements and their vectors.
std::string element_data(const std::vector<std::string>& rows, const std::string& name = "fibres") {
  std::string text =
      "$ElementData\n1\n\"" + name + "\"\n1\n0.0\n3\n0\n3\n" + std::to_string(rows.size()) + "\n";
  for (const auto& row : rows) text += row + "\n";
  return text + "$EndElementData\n";
}

const std::vector<std::string> six{"1 1 0 0", "2 1 0 0", "3 0 2 0", "4 0 2 0", "5 0 0 -3", "6 1 1 1"};

File with_data(File mesh, const std::string& data) {
  mesh.content += data;
  return mesh;
}

/// One tetrahedron with this cell array.
File vtk(const std::string& data) {
  return {"cube.vtk",
          "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0 "
          "0 1 0 "
          "0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\nCELL_DATA 2\n" +
              data};
}

std::vector<Case> good_cases() {
  return {
      good_scene("fibres_constant", edits(muscle, {along_x, "activation: [[0, 0], [1e-3, 1]]"})),
      good_scene("fibres_tendon", edits(tendon, {along_x})),
      good_scene("fibres_curve_quadratic",
                 edits(muscle, {"fibres: {curve: [[-1, 0, 0], [0, 0.5, 0], [1, 0, 0]]}", "activation: 0.5",
                                "order: 2"})),
      {.name = "fibres_gmsh2",
       .files = {scene_with_field("cube.msh",
                                  {by_field, "transform: {rotate: {axis: [0, 0, 1], angle: 30}}"}),
                 with_data(gmsh2(), element_data(six))},
       .exit_code = 0},
      {.name = "fibres_gmsh4_quadratic",
       .files = {scene_with_field("cube.msh", {by_field, "activation: 1", "order: 2"}),
                 with_data(gmsh4(), element_data({"1 9 9"}, "other") + element_data(six))},
       .exit_code = 0,
       .ranks = {1, 2}},
      {.name = "fibres_vtk",
       .files = {scene_with_field("cube.vtk", {by_field}), vtk("VECTORS fibres float\n1 0 0\n0 1 0\n")},
       .exit_code = 0,
       .ranks = {1, 2}},
      {.name = "fibres_in_a_group_only",
       .files = {scene({{isotropic, isotropic + "}\n    groups: {flesh: {material: {" + muscle +
                                        "}, activation: 0.7}}\n    fibres: {field: fibres"},
                        {"generate: box, size: [1, 1, 1], cells: [2, 2, 2], cell: tet6", "file: cube.msh"}}),
                 with_data(gmsh2({{"6 4 2 7 1 1 6 2 7", "6 4 2 8 1 1 6 2 7"}}),
                           element_data({"1 1 0 0", "2 1 0 0", "3 0 2 0", "4 0 2 0", "5 0 0 -3"}))},
       .exit_code = 0},
      {.name = "fibres_restart",
       .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
       .command = "run scene.yaml --restart out/checkpoint.h5",
       .files = {scene(edits(muscle, {along_x, "activation: [[0, 0], [2e-3, 1]]"}))},
       .exit_code = 0},
      {.name = "fibres_check",
       .command = "check scene.yaml",
       .files = {scene(edits(muscle, {along_x, "activation: [[0, 0], [1, 1]]"}))},
       .exit_code = 0,
       .says = {"fibres along (1, 0, 0)", "activation from 0 at 0 s to 1 at 1 s"},
       .ranks = {1}},
      {.name = "fibres_explained",
       .command = "explain bodies.fibres",
       .exit_code = 0,
       .says = {"direction", "curve", "field"},
       .ranks = {1}},
  };
}

std::vector<Case> bad_scenes() {
  return {
      bad_scene("fibres_missing", muscle, {}, {"scene.yaml:6", "bodies.cube: needs 'fibres'"}),
      bad_scene("fibres_of_isotropic", isotropic, {along_x},
                {"bodies.cube.fibres", "muscle and tendon only"}),
      bad_scene("fibres_without_source", muscle, {"fibres: {}"}, {"bodies.cube.fibres", "direction"}),
      bad_scene("fibres_of_two_sources", muscle, {"fibres: {direction: [1, 0, 0], field: fibres}"},
                {"bodies.cube.fibres", "field"}),
      bad_scene("fibres_zero", muscle, {"fibres: {direction: [0, 0, 0]}"}, {"bodies.cube.fibres.direction"}),
      bad_scene("fibres_not_finite", muscle, {"fibres: {direction: [.nan, 0, 0]}"},
                {"bodies.cube.fibres.direction[0]"}),
      bad_scene("fibres_curve_of_a_point", muscle, {"fibres: {curve: [[0, 0, 0]]}"},
                {"bodies.cube.fibres.curve", "two points at least"}),
      bad_scene("fibres_curve_stands_still", muscle, {"fibres: {curve: [[0, 0, 0], [1, 0, 0], [1, 0, 0]]}"},
                {"bodies.cube.fibres.curve[2]", "the point before it"}),
      bad_scene("fibres_curve_of_infinity", muscle, {"fibres: {curve: [[0, 0, 0], [.inf, 0, 0]]}"},
                {"bodies.cube.fibres.curve[1]"}),
      bad_scene("fibres_field_of_generated", muscle, {by_field},
                {"bodies.cube.fibres.field", "goes with a mesh file only"}),
      bad_scene("activation_too_high", muscle, {along_x, "activation: 1.5"},
                {"scene.yaml:11", "bodies.cube.activation", "[0, 1]"}),
      bad_scene("activation_negative", muscle, {along_x, "activation: [[0, 0], [1, -0.1]]"},
                {"bodies.cube.activation[1][1]", "[0, 1]"}),
      bad_scene("activation_not_a_number", muscle, {along_x, "activation: .nan"}, {"bodies.cube.activation"}),
      bad_scene("activation_out_of_order", muscle, {along_x, "activation: [[0, 0], [1, 1], [0.5, 0]]"},
                {"scene.yaml:11", "bodies.cube.activation[2]", "not later"}),
      bad_scene("activation_twice_at_a_time", muscle, {along_x, "activation: [[0, 0], [0, 1]]"},
                {"bodies.cube.activation[1]", "not later"}),
      bad_scene("activation_of_three_numbers", muscle, {along_x, "activation: [[0, 0, 0]]"},
                {"bodies.cube.activation[0]", "2 numbers"}),
      bad_scene("activation_of_numbers", muscle, {along_x, "activation: [0, 1]"},
                {"bodies.cube.activation[0]", "2 numbers"}),
      bad_scene("activation_of_nothing", muscle, {along_x, "activation: []"},
                {"bodies.cube.activation", "empty list"}),
      bad_scene("activation_of_tendon", tendon, {along_x, "activation: 1"},
                {"bodies.cube.activation", "'model: muscle' only"}),
      bad_scene("activation_of_a_tendon_group", muscle,
                {along_x, "groups: {flesh: {material: {" + tendon + "}, activation: 1}}"},
                {"bodies.cube.groups.flesh.activation", "'model: muscle' only"}),
      bad_scene("muscle_without_matrix", "model: muscle, youngs_modulus: 0, poissons_ratio: 0.3", {along_x},
                {"bodies.cube.material.youngs_modulus", "must be > 0"}),
      bad_scene("muscle_overflows", muscle + ", passive_exponent: 1000", {along_x},
                {"bodies.cube.material.passive_exponent", "at most 50"}),
      bad_scene("muscle_too_wide", muscle + ", active_width: 1", {along_x},
                {"bodies.cube.material.active_width", "(0, 1)"}),
      bad_scene("muscle_clamped", muscle + ", extension: clamp", {along_x},
                {"bodies.cube.material.extension", "only with neo_hookean"}),
      bad_scene("tendon_active", tendon + ", active_width: 0.5", {along_x},
                {"bodies.cube.material.active_width", "only with muscle"}),
      bad_scene("peak_stress_of_isotropic", isotropic + ", peak_stress: 1e5", {},
                {"bodies.cube.material.peak_stress", "only with muscle"}),
      {.name = "muscle_without_matrix_by_event",
       .files = {scene(
           {{isotropic, muscle + "}\n    " + along_x.substr(0, along_x.size() - 1)},
            {"petsc:", "events: [{at: 1e-3, set: bodies.cube.material.youngs_modulus, to: 0}]\npetsc:"}})},
       .says = {"youngs_modulus", "must be > 0"}},
  };
}

std::vector<Case> bad_fields() {
  auto one_zero = six, one_infinite = six, one_unknown = six, one_missing = six;
  one_zero[2] = "3 0 0 0";
  one_infinite[2] = "3 0 inf 0";
  one_unknown[2] = "33 0 1 0";
  one_missing.pop_back();
  return {
      bad_field("fibre_field_missing", gmsh2(),
                {"cube.msh: has no cell field of vectors called 'fibres'", "it has none"}),
      bad_field("fibre_field_misspelt", with_data(gmsh2(), element_data(six, "fibers")),
                {"did you mean 'fibers'?"}),
      bad_field("fibre_field_of_medit", medit(), {"cube.mesh: has no cell field of vectors", "it has none"}),
      bad_field("fibre_field_zero", with_data(gmsh2(), element_data(one_zero)),
                {"bodies.cube.fibres.field: 'fibres' is zero or missing in 1 of 6 cells", "cell 2,"}),
      bad_field("fibre_field_too_short", with_data(gmsh2(), element_data(one_missing)),
                {"bodies.cube.fibres.field: 'fibres' is zero or missing in 1 of 6 cells", "cell 5,"}),
      bad_field("fibre_field_not_finite", with_data(gmsh2(), element_data(one_infinite)),
                {"cube.msh:", "a component of a vector must be a finite number"}),
      bad_field("fibre_field_of_no_element", with_data(gmsh4(), element_data(one_unknown)),
                {"cube.msh:", "there is no element 33"}),
      bad_field("fibre_field_of_scalars", vtk("SCALARS fibres float 1\nLOOKUP_TABLE default\n1 2\n"),
                {"cube.vtk:", "has 1 components; it must have 3"}),
      bad_field("fibre_field_wrong_length", vtk("FIELD all 1\nfibres 3 1 float\n1 0 0\n"),
                {"cube.vtk:", "there are 2 cells, but 1 vectors"}),
      bad_field("fibre_field_cut", cut(with_data(gmsh2(), element_data(six)), 9), {"cube.msh"}),
  };
}

}  // namespace

std::vector<Case> fibre_cases() {
  std::vector<Case> all;
  for (const auto& group : {good_cases(), bad_scenes(), bad_fields()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace evert::cli
