#include <gtest/gtest.h>

#include "case.hpp"
#include <fstream>
#include <sstream>

/// Cases of `evert stability`.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;

/// The table of all 48 elements, whatever the number of ranks.
void expect_table(const fs::path& place) {
  std::ifstream file(place / "table.csv");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "element,region,type,shape,step_own_masses_s,step_nodal_masses_s,energy_share");
  int elements = 0;
  double energy = 0;
  for (; std::getline(file, line); ++elements) {
    EXPECT_TRUE(line.starts_with(std::to_string(elements) + ",cube,tet4,well-shaped,")) << line;
    energy += std::stod(line.substr(line.rfind(',') + 1));
  }
  EXPECT_EQ(elements, 48);
  EXPECT_NEAR(energy, 1, 1e-4);
}

Case bad(const std::string& name, const std::string& arguments, const std::vector<std::string>& says,
         int exit_code = 2) {
  return {.name = "stability_" + name,
          .command = "stability " + arguments,
          .files = {scene()},
          .exit_code = exit_code,
          .says = says};
}

const std::vector<Case> cases{
    // Figures that every number of ranks must print.
    {.name = "stability",
     .command = "stability scene.yaml -o table.csv",
     .files = {scene()},
     .exit_code = 0,
     .says = {"27 nodes, 48 elements", "true limit", "Collatz-Wielandt", "well-shaped          48",
              "is what auto takes", "table of all elements: table.csv"},
     .inspect = expect_table},
    {.name = "stability_at_the_start",
     .command = "stability scene.yaml -set 'bodies.cube.start={kind: flatten_plane, amplitude: 0.5}'",
     .files = {scene()},
     .exit_code = 0,
     .says = {"at rest:", "at t = 0 s:"}},
    {.name = "stability_at_a_checkpoint",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
     .command = "stability scene.yaml -restart out/checkpoint.h5",
     .files = {scene()},
     .exit_code = 0,
     .says = {"at rest:", "at t = 0.002 s:"}},
    {.name = "stability_of_other_elements",
     .command = "stability scene.yaml",
     .files = {scene({{"cell: tet6", "cell: hex8"}})},
     .exit_code = 0,
     .says = {"hex8                  8"}},
    {.name = "stability_of_no_stiffness",
     .command = "stability scene.yaml -set bodies.cube.material.youngs_modulus=0 -stability_eps_tol 1e-6",
     .files = {scene()},
     .exit_code = 0,
     .says = {"no limit"}},
    {.name = "stability_help", .command = "stability -help", .exit_code = 0, .says = {"-o table.csv"}},
    bad("consistent", "scene.yaml -set obstacles=null -set integrator.mass=consistent",
        {"integrator.mass: must be lumped for evert stability"}),
    bad("no_scene", "", {"evert stability needs a scene file"}),
    bad("missing_scene", "nowhere.yaml", {"nowhere.yaml", "no such file"}),
    bad("no_table", "scene.yaml -o", {"-o needs a value"}),
    bad("table_is_a_directory", "scene.yaml -o .", {"."}),
    bad("output_of_run", "scene.yaml -output here", {"-output is of evert run", "-o FILE"}),
    bad("no_checkpoint", "scene.yaml -restart none.h5", {"none.h5"}),
    bad("unknown_option", "scene.yaml -stability_eps_toll 1e-3",
        {"-stability_eps_toll: unknown option", "did you mean '-stability_eps_tol'?"}),
    bad("option_without_value", "scene.yaml -stability_eps_tol", {"-stability_eps_tol: needs a value"}),
    bad("unknown_solver", "scene.yaml -stability_eps_type none", {"none"}),
    bad("not_found", "scene.yaml -stability_eps_max_it 1 -stability_eps_ncv 3 -stability_eps_tol 1e-15",
        {"the simulation failed", "-stability_eps_max_it"}, 3),
    {.name = "stability_option_of_a_run",
     .command = "run scene.yaml -stability_eps_tol 1e-6",
     .files = {scene()},
     .says = {"-stability_eps_tol: has no effect here", "evert stability"}},
    {.name = "stability_of_a_flat_cell",
     .command = "stability scene.yaml",
     .files = {scene_with_mesh("cube.msh"), gmsh2({{"7 1 1 1", "7 1 1 0"}})},
     .says = {"cube.msh"}},
};

}  // namespace

std::vector<Case> stability_cases() { return cases; }

}  // namespace evert::cli
