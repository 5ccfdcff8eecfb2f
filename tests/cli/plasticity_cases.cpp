#include "case.hpp"

/// Plastic flow.
namespace evert::cli {
namespace {

/// The good scene with plasticity of its body.
Case bad_plasticity(const std::string& name, const std::string& keys, const std::vector<std::string>& says,
                    const std::vector<File>& more = {}) {
  Case made{.name = "plasticity_" + name, .says = says};
  made.files.push_back(
      scene({{"    density: 1000\n", "    density: 1000\n    plasticity: {" + keys + "}\n"}}));
  made.files.insert(made.files.end(), more.begin(), more.end());
  return made;
}

}  // namespace

std::vector<Case> plasticity_cases() {
  std::vector<Case> cases{
      bad_plasticity("yield_zero", "yield_strain: 0", {"yield_strain", "must be > 0"}),
      bad_plasticity("yield_negative", "yield_stress: -1", {"yield_stress", "must be > 0"}),
      bad_plasticity("no_yield", "hardening: 0.1",
                     {"needs either 'yield_strain' [-] or 'yield_stress' [Pa]"}),
      bad_plasticity("two_yields", "yield_strain: 0.1, yield_stress: 1", {"needs either 'yield_strain'"}),
      bad_plasticity("two_hardenings", "yield_strain: 0.1, hardening: 1, hardening_modulus: 1", {"not both"}),
      bad_plasticity("limit_of_one", "yield_strain: 0.1, limit: 1", {"limit", "must be > 1"}),
      bad_plasticity("control_and_isochoric", "yield_strain: 0.1, isochoric: true, goal: {flatten: 0.5}",
                     {"plasticity.isochoric", "does not go with 'goal'"}),
      bad_plasticity("stress_of_other_flow", "yield_stress: 1e3, isochoric: false",
                     {"yield_stress", "is a stress of isochoric flow"}),
      bad_plasticity("misspelt_goal", "yield_strain: 0.1, goal: {flaten: 0.5}", {"goal", "flatten"}),
      bad_plasticity("empty_window", "yield_strain: 0.1, goal: {flatten: 0.5, from: 2, until: 1}",
                     {"goal.until", "must be after 'from'"}),
      bad_plasticity("goal_beyond_the_limit", "yield_strain: 0.1, goal: {flatten: 0.1}",
                     {"bodies.cube.plasticity.goal: 48 elements would be turned inside out or flat",
                      "more than 4 times", "the first are 0, 1, 2, 3, 4, 5, 6, 7"}),
      bad_plasticity("goal_inside_out", "yield_strain: 0.1, goal: {bend: 50}",
                     {"elements would be turned inside out"}),
      bad_plasticity("goal_of_no_file", "yield_strain: 0.1, goal: {file: none.msh}", {"none.msh"}),
      bad_plasticity("goal_mesh_of_other_size", "yield_strain: 0.1, goal: {file: small.msh}",
                     {"is not the body's mesh in another shape: it has 8 nodes, the body's has "},
                     {{"small.msh", gmsh2().content}}),
      bad_plasticity("goal_of_too_few_numbers", "yield_strain: 0.1, goal: {deformations: few.txt}",
                     {"has 9 numbers, but nine for each cell are 432"}, {{"few.txt", "1 0 0 0 1 0 0 0 1\n"}}),
      bad_plasticity("goal_of_words", "yield_strain: 0.1, goal: {deformations: words.txt}",
                     {"has something that is no number after 2 numbers"}, {{"words.txt", "1 0 x\n"}}),
  };
  Case filtered = bad_plasticity("filtered", "yield_strain: 0.1",
                                 {"filter.constraints: 'none' does not go with plasticity", "'compliant'"});
  filtered.command = "run scene.yaml -set filter.time_step=1e-2 -set filter.constraints=none";
  cases.push_back(filtered);
  Case resting = bad_plasticity("at_rest", "yield_strain: 0.1", {"quasistatic"});
  resting.command =
      "run scene.yaml -set integrator.method=quasistatic -set obstacles=null -set gravity=[0,0,0]";
  cases.push_back(resting);
  Case mixed = bad_plasticity("mixed", "yield_strain: 0.1", {"does not go with 'precision: mixed'"});
  mixed.command = "run scene.yaml -set bodies.cube.precision=mixed";
  cases.push_back(mixed);
  return cases;
}

}  // namespace evert::cli
