#include <gtest/gtest.h>

#include "case.hpp"
#include <fstream>
#include <sstream>

/// What the program says to wrong input. One entry a case: to add one, copy the nearest and change it. What
/// an entry leaves out is the default of case.hpp: `evert run scene.yaml`, exit code 2, at 1 and 3 ranks.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;

/// The good file with one edit, and what the program must say.
Case bad_scene(const std::string& name, const Edit& edit, const std::vector<std::string>& says) {
  return {.name = name, .files = {scene({edit})}, .says = says};
}

Case bad_mesh(const std::string& name, const File& mesh, const std::vector<std::string>& says) {
  return {.name = name, .files = {scene_with_mesh(mesh.path), mesh}, .says = says};
}

/// With an option for the damping solves, which it does not make.
File undamped_scene() {
  return scene({{"    damping: {model: rotated, stiffness_proportional: 0.01}\n", ""}});
}

Case bad_command(const std::string& name, const std::string& command, const std::vector<std::string>& says) {
  return {.name = name, .command = command, .files = {scene()}, .says = says};
}

/// Restart from what is left of a checkpoint of the good scene.
Case bad_restart(const std::string& name, const std::function<void(const fs::path& place)>& spoil,
                 const std::vector<std::string>& says) {
  return {.name = name,
          .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
          .spoil = spoil,
          .command = "run scene.yaml --restart out/checkpoint.h5",
          .files = {scene()},
          .says = says};
}

void truncate(const fs::path& file, double fraction) {
  fs::resize_file(file, static_cast<std::uintmax_t>(static_cast<double>(fs::file_size(file)) * fraction));
}

const Edit halfway_event{"petsc:", "events: [{at: 5e-4, set: gravity, to: [0, 0, 0]}]\npetsc:"};

const std::vector<Case> good_runs{
    {.name = "good_scene", .files = {scene()}, .exit_code = 0},
    {.name = "good_option_of_the_solve",
     .command = "run scene.yaml -damping_ksp_converged_reason",
     .files = {scene()},
     .exit_code = 0,
     .says = {"Linear damping_ solve converged"}},
    {.name = "good_wedges", .files = {scene({{"cell: tet6", "cell: wedge6"}})}, .exit_code = 0},
    {.name = "good_quadratic",
     .files = {scene({{"    density: 1000\n", "    density: 1000\n    order: 2\n"}})},
     .exit_code = 0},
    {.name = "good_gmsh2", .files = {scene_with_mesh("cube.msh"), gmsh2()}, .exit_code = 0},
    {.name = "good_gmsh4", .files = {scene_with_mesh("cube.msh"), gmsh4()}, .exit_code = 0},
    {.name = "good_medit", .files = {scene_with_mesh("cube.mesh"), medit()}, .exit_code = 0},
    {.name = "good_mooney_rivlin",
     .files = {scene({{"model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3",
                       "model: mooney_rivlin, mu_10: 6e4, mu_01: 2e4, bulk_modulus: 6e5"}})},
     .exit_code = 0},
    {.name = "good_spline", .files = {scene({{"neo_hookean", "spline"}})}, .exit_code = 0},
    {.name = "good_stable_neo_hookean",
     .files = {scene({{"model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3",
                       "model: stable_neo_hookean, lambda: 5e4, mu: 4e4"}})},
     .exit_code = 0},
    {.name = "good_restart",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
     .command = "run scene.yaml --restart out/checkpoint.h5",
     .files = {scene()},
     .exit_code = 0},
    {.name = "check", .command = "check scene.yaml", .files = {scene()}, .exit_code = 0, .says = {"48"}},
    {.name = "check_tells_what_features_cost",
     .command = "check scene.yaml",
     .files = {scene()},
     .exit_code = 0,
     .says = {"plastic state 0.0 MB", "work  ", " of these steps", "obstacles: a step costs ", " MB"}},
    // 0.4 ms at most, from stop to stop: 0.5 and 0.5 ms around the event, 1 ms to the next frame.
    {.name = "check_counts_steps",
     .command = "check scene.yaml -set integrator.time_step=4e-4",
     .files = {scene({halfway_event})},
     .exit_code = 0,
     .says = {"about 7 to the end time"}},
    {.name = "run_makes_these_steps",
     .command = "run scene.yaml -set integrator.time_step=4e-4",
     .files = {scene({halfway_event})},
     .exit_code = 0,
     .says = {", 7 steps in"}},
    {.name = "quiet", .command = "run scene.yaml -quiet", .files = {scene()}, .exit_code = 0},
    {.name = "icc_on_one_rank",
     .command = "run scene.yaml -damping_mat_type sbaij -damping_pc_type icc",
     .files = {scene()},
     .exit_code = 0,
     .ranks = {1}},
    {.name = "gamg",
     .command = "run scene.yaml -damping_mat_type aij -damping_pc_type gamg",
     .files = {scene()},
     .exit_code = 0},
    {.name = "solver_of_the_transpose",
     .command = "run scene.yaml -damping_ksp_type bicg",
     .files = {scene()},
     .exit_code = 0},
    {.name = "version", .command = "--version", .exit_code = 0, .says = {"evert "}},
    {.name = "help", .command = "run -help", .exit_code = 0, .says = {"damping_ksp_rtol"}},
    {.name = "bench_step",
     .command = "bench step scene.yaml",
     .files = {scene()},
     .exit_code = 0,
     .says = {"us per cell and step", "damping_solve"}},
    {.name = "bench_help", .command = "bench --help", .exit_code = 0, .says = {"-bench_json"}},
    {.name = "no_command", .command = "", .exit_code = 0, .says = {"evert run SCENE.yaml"}},
    {.name = "check_help",
     .command = "check --help",
     .exit_code = 0,
     .says = {"evert check SCENE.yaml", "-set"}},
    {.name = "explain_help", .command = "explain -h", .exit_code = 0, .says = {"evert explain KEY"}},
    {.name = "view_help", .command = "view -help", .exit_code = 0, .says = {"evert view RUN.h5", "-frames"}},
    {.name = "mesh_help", .command = "mesh convert --help", .exit_code = 0, .says = {"evert mesh generate"}},
    {.name = "explain_all",
     .command = "explain",
     .exit_code = 0,
     .says = {"youngs_modulus [Pa]", "with generate: torus"},
     .ranks = {1}},
    {.name = "explain",
     .command = "explain bodies.material.poissons_ratio",
     .exit_code = 0,
     .says = {"poissons_ratio"},
     .ranks = {1}},
};

/// `evert view` of what is left of the good scene's run.
Case bad_view(const std::string& name, const std::string& arguments, const std::vector<std::string>& says,
              const std::function<void(const fs::path& place)>& spoil = {}) {
  return {.name = name,
          .before = "run scene.yaml",
          .spoil = spoil,
          .command = "view " + arguments,
          .files = {scene()},
          .says = says,
          .ranks = {1}};
}

const std::vector<Case> views{
    {.name = "view",
     .before = "run scene.yaml",
     .command = "view out/run.h5 -frames 2",
     .files = {scene()},
     .exit_code = 0,
     .says = {"2 of 3 frames", "out/run.html"}},
    bad_view("view_nothing", "", {"needs a run file"}),
    bad_view("view_missing", "nowhere.h5", {"nowhere.h5: there is no such file"}),
    bad_view("view_directory", "out", {"out: is a directory"}),
    bad_view("view_no_run", "scene.yaml", {"scene.yaml"}),
    bad_view("view_checkpoint", "out/checkpoint.h5", {"checkpoint.h5"}),
    bad_view("view_cut_run", "out/run.h5", {"run.h5"},
             [](const fs::path& place) { truncate(place / "out/run.h5", 0.6); }),
    bad_view("view_over_the_run", "out/run.h5 -o out/run.h5", {"is the run itself", "-o"}),
    bad_view("view_without_frames", "out/run.h5 -frames 0", {"-frames", "at least 1", "'0'"}),
    bad_view("view_unknown_option", "out/run.h5 -frame 3", {"-frame", "did you mean '-frames'?"}),
    bad_view("view_unwritable", "out/run.h5 -o scene.yaml/view.html", {"scene.yaml/view.html"}),
};

const std::vector<Case> bad_commands{
    bad_command("unknown_command", "rum scene.yaml", {"'rum'", "did you mean 'run'?"}),
    bad_command("no_scene", "run", {"evert run needs a scene file"}),
    bad_command("no_scene_check", "check", {"evert check needs a scene file"}),
    bad_command("two_scenes", "run scene.yaml scene.yaml", {"scene.yaml"}),
    bad_command("missing_scene", "run nowhere.yaml", {"nowhere.yaml: there is no such file"}),
    {.name = "scene_is_directory", .files = {{"scene.yaml/"}}, .says = {"scene.yaml: is a directory"}},
    bad_command("unknown_option", "run scene.yaml -damping_ksp_rtoll 1e-3",
                {"damping_ksp_rtoll", "did you mean '-damping_ksp_rtol'?"}),
    bad_command("unknown_option_of_nobody", "run scene.yaml -xyzzy", {"xyzzy"}),
    bad_command("unknown_option_check", "check scene.yaml -damping_ksp_typ cg", {"damping_ksp_typ"}),
    bad_command("unknown_solver", "run scene.yaml -damping_ksp_type conjugate", {"conjugate"}),
    bad_command("unknown_preconditioner", "run scene.yaml -damping_pc_type jakobi", {"jakobi"}),
    bad_command("option_without_number", "run scene.yaml -damping_ksp_rtol small",
                {"PETSc refuses", "small"}),
    bad_command("option_without_value", "run scene.yaml -damping_ksp_rtol",
                {"-damping_ksp_rtol: needs a value"}),
    bad_command("missing_options_file", "run scene.yaml -options_file nowhere",
                {"-options_file nowhere", "no such file"}),
    bad_command("log_to_nowhere", "run scene.yaml -log_view :nowhere/log", {"PETSc does not end"}),
    bad_command("tolerance_of_nothing", "run scene.yaml -damping_ksp_rtol 2",
                {"-damping_ksp_rtol", "[0, 1)"}),
    bad_command("negative_tolerance", "run scene.yaml -damping_ksp_atol -1", {"-damping_ksp_atol", ">= 0"}),
    bad_command("no_solver", "run scene.yaml -damping_ksp_type preonly",
                {"preonly solves nothing", "pbjacobi", "lu"}),
    bad_command("shell_preconditioner", "run scene.yaml -damping_pc_type shell",
                {"-damping_pc_type shell is not allowed", "pbjacobi"}),
    bad_command("entries_for_gamg", "run scene.yaml -damping_pc_type gamg", {"add -damping_mat_type aij"}),
    bad_command("gamg_of_blocks", "run scene.yaml -damping_mat_type baij -damping_pc_type gamg",
                {"-damping_pc_type gamg does not work with -damping_mat_type baij: must be aij"}),
    bad_command("blocks_of_a_triangle", "run scene.yaml -damping_mat_type sbaij -damping_pc_type pbjacobi",
                {"does not work with -damping_mat_type sbaij: must be shell, baij or aij"}),
    {.name = "icc_on_several_ranks",
     .command = "run scene.yaml -damping_mat_type sbaij -damping_pc_type icc",
     .files = {scene()},
     .says = {"one rank only", "-damping_pc_type bjacobi -damping_sub_pc_type icc"},
     .ranks = {2, 3}},
    bad_command("composite_of_nothing", "run scene.yaml -damping_mat_type aij -damping_pc_type composite",
                {"PETSc refuses"}),
    bad_command("load_steps_of_a_motion", "run scene.yaml -set integrator.load_steps=4",
                {"integrator.load_steps", "has no effect", "quasistatic"}),
    {.name = "option_without_damping",
     .files = {undamped_scene()},
     .says = {"-damping_ksp_rtol", "has no effect", "nothing in this scene is damped"}},
    {.name = "option_without_damping_check",
     .command = "check scene.yaml",
     .files = {undamped_scene()},
     .says = {"-damping_ksp_rtol", "has no effect", "nothing in this scene is damped"}},
    bad_command("set_without_value", "run scene.yaml -set end_time", {"path=value"}),
    bad_command("set_without_argument", "run scene.yaml -set", {"-set"}),
    bad_command("set_unknown_key", "run scene.yaml -set integrator.time_stepp=1e-4",
                {"-set integrator.time_stepp", "did you mean 'time_step'?"}),
    bad_command("set_unknown_body", "run scene.yaml -set bodies.cubes.density=1", {"bodies.cubes", "'cube'"}),
    bad_command("set_out_of_range", "run scene.yaml -set bodies.cube.density=-1",
                {"bodies.cube.density", "> 0"}),
    bad_command("bench_nothing", "bench", {"evert bench needs a command: kernels"}),
    bad_command("bench_step_of_nothing", "bench step", {"scene"}),
    bad_command("bench_step_unknown_option", "bench step scene.yaml -damping_ksp_rtoll 1e-3",
                {"damping_ksp_rtoll", "did you mean '-damping_ksp_rtol'?"}),
    bad_command("bench_unknown_command", "bench kernel", {"'kernel'", "did you mean 'kernels'?"}),
    bad_command("bench_unknown_option", "bench kernels -bench_jsn f",
                {"no option -bench_jsn", "did you mean '-bench_json'?"}),
    bad_command("bench_without_value", "bench kernels -bench_json", {"-bench_json needs a value"}),
    bad_command("bench_unknown_size", "bench kernels -bench_size 10K", {"'10K'", "small, 100K or 1M"}),
    bad_command("bench_empty_size", "bench kernels -bench_size small,", {"''", "small, 100K or 1M"}),
    bad_command("bench_no_time", "bench kernels -bench_seconds 0", {"-bench_seconds", "above 0", "not 0"}),
    bad_command("bench_odd_time", "bench kernels -bench_seconds soon", {"-bench_seconds", "'soon'"}),
    bad_command("bench_elements_unknown_size", "bench elements -bench_size huge",
                {"'huge'", "small or full"}),
    bad_command("bench_elements_no_time", "bench elements -bench_seconds 0",
                {"bench elements: -bench_seconds"}),
    bad_command("bench_elements_svg_in_proc", "bench elements -bench_size small -bench_svg /proc/f.svg",
                {"/proc/f.svg"}),
    bad_command("bench_one_argument_too_many", "bench kernels scene.yaml", {"'scene.yaml'", "too many"}),
    bad_command("bench_json_in_proc", "bench kernels -bench_size small -bench_json /proc/f.json",
                {"/proc/f.json"}),
    bad_command("explain_unknown_key", "explain bodies.materiel", {"'bodies.materiel' is no key"}),
};

const std::vector<Case> bad_scenes{
    {.name = "empty_scene", .files = {{"scene.yaml", ""}}, .says = {"scene.yaml: holds nothing"}},
    {.name = "binary_scene",
     .files = {{"scene.yaml", std::string("\x00\x01\x02", 3)}},
     .says = {"zero bytes"}},
    {.name = "scene_is_a_list", .files = {{"scene.yaml", "[1, 2]\n"}}, .says = {"map of keys"}},
    {.name = "scene_cut_short", .files = {cut(scene(), 5)}, .says = {"scene.yaml:"}},
    bad_scene("not_yaml", {"density: 1000", "density: {1000"}, {"scene.yaml:", "YAML"}),
    bad_scene("misspelt_key", {"density: 1000", "densty: 1000"},
              {"scene.yaml:8", "densty", "did you mean 'density'?"}),
    bad_scene("misspelt_top_key", {"gravity:", "gravitiy:"}, {"scene.yaml:3", "did you mean 'gravity'?"}),
    bad_scene("unknown_key", {"end_time: 2e-3", "end_time: 2e-3\nxyzzy: 1"}, {"scene.yaml:3", "xyzzy"}),
    bad_scene("duplicate_key", {"end_time: 2e-3", "end_time: 2e-3\nend_time: 1"},
              {"scene.yaml:3", "duplicate key 'end_time'", "scene.yaml:2"}),
    bad_scene("missing_key", {"    density: 1000\n", ""}, {"bodies.cube", "density"}),
    {.name = "missing_bodies", .files = {{"scene.yaml", "name: void\nend_time: 1\n"}}, .says = {"'bodies'"}},
    {.name = "no_body",
     .files = {{"scene.yaml", "name: void\nend_time: 1\nbodies: {}\n"}},
     .says = {"scene.yaml:3", "at least one body"}},
    bad_scene("wrong_type", {"density: 1000", "density: heavy"},
              {"scene.yaml:8", "bodies.cube.density", "'heavy'"}),
    bad_scene("list_for_number", {"density: 1000", "density: [1000]"}, {"bodies.cube.density", "a list"}),
    bad_scene("number_for_list", {"gravity: [0, -9.81, 0]", "gravity: -9.81"}, {"gravity"}),
    bad_scene("short_vector", {"gravity: [0, -9.81, 0]", "gravity: [0, -9.81]"}, {"gravity", "3 numbers"}),
    bad_scene("not_a_number", {"density: 1000", "density: .nan"}, {"bodies.cube.density"}),
    bad_scene("infinite", {"density: 1000", "density: .inf"}, {"bodies.cube.density"}),
    bad_scene("huge", {"density: 1000", "density: 1e999"}, {"bodies.cube.density"}),
    bad_scene("number_with_unit", {"density: 1000", "density: 1000 kg/m^3"}, {"bodies.cube.density"}),
    bad_scene("negative_density", {"density: 1000", "density: -1000"}, {"bodies.cube.density", "> 0"}),
    bad_scene("zero_end_time", {"end_time: 2e-3", "end_time: 0"}, {"scene.yaml:2", "end_time", "> 0"}),
    bad_scene("incompressible", {"poissons_ratio: 0.3", "poissons_ratio: 0.5"},
              {"bodies.cube.material.poissons_ratio", "(-1, 0.5)"}),
    bad_scene("negative_stiffness", {"youngs_modulus: 1e5", "youngs_modulus: -1"},
              {"bodies.cube.material.youngs_modulus", ">= 0"}),
    bad_scene("auxetic", {"poissons_ratio: 0.3", "poissons_ratio: -1"},
              {"bodies.cube.material.poissons_ratio", "(-1, 0.5)"}),
    bad_scene("limit_beyond_rest", {"poissons_ratio: 0.3", "poissons_ratio: 0.3, compression_limit: 1"},
              {"scene.yaml:9", "bodies.cube.material.compression_limit", "(0, 1)"}),
    bad_scene("limits_in_wrong_order",
              {"model: neo_hookean", "model: spline, compression_limit: 0.9, elongation_limit: 0.8"},
              {"scene.yaml:9", "bodies.cube.material.elongation_limit", ">= 1"}),
    bad_scene("moduli_in_two_ways", {"poissons_ratio: 0.3", "poissons_ratio: 0.3, lambda: 1e5, mu: 1e5"},
              {"scene.yaml:9", "bodies.cube.material: needs either", "'lambda' and 'mu'"}),
    bad_scene("constant_of_another_model", {"poissons_ratio: 0.3", "poissons_ratio: 0.3, mu_01_share: 0.2"},
              {"mu_01_share", "only with mooney_rivlin"}),
    bad_scene("damping_ratio_without_frequency", {"stiffness_proportional: 0.01", "stiffness_ratio: 0.01"},
              {"scene.yaml:10", "bodies.cube.damping", "'frequency' [Hz]"}),
    bad_scene("damping_ratio_below_zero",
              {"stiffness_proportional: 0.01", "stiffness_ratio: -0.01, frequency: 1"},
              {"bodies.cube.damping.stiffness_ratio", ">= 0"}),
    bad_scene("damping_ratio_at_no_frequency",
              {"stiffness_proportional: 0.01", "stiffness_ratio: 0.01, frequency: 0"},
              {"bodies.cube.damping.frequency", "> 0"}),
    bad_scene("mass_damping_below_zero",
              {"stiffness_proportional: 0.01", "stiffness_proportional: 0.01, mass_proportional: -1"},
              {"bodies.cube.damping.mass_proportional", ">= 0"}),
    bad_scene("unknown_damping", {"model: rotated", "model: blendid"},
              {"scene.yaml:10", "did you mean 'blended'?"}),
    bad_scene("unknown_model", {"neo_hookean", "neohookean"},
              {"scene.yaml:9", "did you mean 'neo_hookean'?"}),
    bad_scene("unknown_shape", {"half_space", "halfspace"}, {"scene.yaml:12", "did you mean 'half_space'?"}),
    bad_scene("no_direction", {"normal: [0, 1, 0]", "normal: [0, 0, 0]"}, {"obstacles.ground.normal"}),
    bad_scene("unknown_generator", {"generate: box", "generate: bocks"}, {"bodies.cube.mesh", "box"}),
    bad_scene("too_many_cells", {"cells: [2, 2, 2]", "cells: [1000000, 1000000, 1000000]"},
              {"bodies.cube.mesh.cells", "too many"}),
    bad_scene("hole_beside_the_middle", {"cells: [2, 2, 2]", "cells: [4, 4, 2], hole: [2, 1]"},
              {"bodies.cube.mesh.hole", "1 of 4 along y"}),
    bad_scene("cross_beside_the_middle", {"cells: [2, 2, 2]", "cells: [4, 4, 3], cross: 2"},
              {"bodies.cube.mesh.cross", "in the middle", "2 of 3 along z"}),
    bad_scene("cross_and_hole", {"cells: [2, 2, 2]", "cells: [4, 4, 4], cross: 2, hole: [2, 2]"},
              {"'hole' and 'cross' exclude each other"}),
    bad_scene("hole_as_wide_as_the_box", {"cells: [2, 2, 2]", "cells: [4, 4, 2], hole: [4, 2]"},
              {"bodies.cube.mesh.hole", "4 of 4 along x"}),
    bad_scene("hole_without_cells", {"cells: [2, 2, 2]", "edge_length: 0.5, hole: [1, 1]"},
              {"bodies.cube.mesh.hole", "needs 'cells'"}),
    bad_scene("no_cells", {"cells: [2, 2, 2]", "cells: [0, 2, 2]"}, {"bodies.cube.mesh.cells[0]"}),
    bad_scene("event_on_missing_body",
              {"petsc:", "events: [{at: 0, set: bodies.ball.material.youngs_modulus, to: 1}]\npetsc:"},
              {"events[0]", "ball"}),
    bad_scene("constraint_on_missing_body",
              {"petsc:", "constraints: [{body: ball, node_set: x_min, fixed: true}]\npetsc:"},
              {"constraints[0].body", "'ball'", "cube"}),
    bad_scene("constraint_on_missing_nodes",
              {"petsc:", "constraints: [{body: cube, node_set: left, fixed: true}]\npetsc:"},
              {"left", "x_min"}),
    bad_scene("petsc_option_of_the_process", {"petsc: {", "petsc: {log_view: null, "},
              {"scene.yaml:13", "petsc.log_view", "command line"}),
    bad_scene("petsc_option_without_value", {"damping_ksp_rtol: 1e-6", "damping_ksp_rtol: null"},
              {"petsc.damping_ksp_rtol: needs a value"}),
    bad_scene("petsc_list", {"damping_ksp_rtol: 1e-6", "damping_ksp_rtol: [1e-6]"},
              {"scene.yaml:13", "petsc.damping_ksp_rtol", "not a list"}),
    bad_scene("unknown_petsc_option", {"damping_ksp_rtol", "damping_ksp_rtl"},
              {"damping_ksp_rtl", "damping_ksp_rtol"}),
    bad_scene("order_of_three", {"    density: 1000\n", "    density: 1000\n    order: 3\n"}, {"order", "2"}),
    {.name = "quadratic_hexahedra",
     .files = {scene(
         {{"cell: tet6", "cell: hex8"}, {"    density: 1000\n", "    density: 1000\n    order: 2\n"}})},
     .says = {"bodies.cube.order", "only tetrahedra", "hex8"}},
    {.name = "more_ranks_than_cells",
     .files = {scene({{"cells: [2, 2, 2], cell: tet6", "cells: [1, 1, 1], cell: hex8"}})},
     .says = {"rank"},
     .ranks = {3}},
};

const std::vector<Case> bad_meshes{
    {.name = "missing_mesh",
     .files = {scene_with_mesh("cube.msh")},
     .says = {"cube.msh: there is no such file"}},
    {.name = "mesh_is_directory",
     .files = {scene_with_mesh("cube.msh"), {"cube.msh/"}},
     .says = {"is a directory"}},
    bad_mesh("unknown_format", {"cube.stl", "solid cube\n"}, {"cube.stl", "allowed are Gmsh"}),
    bad_mesh("gmsh_of_version_3", gmsh2({{"2.2 0 8", "3.0 0 8"}}), {"cube.msh:2", "allowed are 2.2 and 4.1"}),
    bad_mesh("gmsh_of_unknown_element", gmsh2({{"1 4 2 7 1 1 2 3 7", "1 77 2 7 1 1 2 3 7"}}),
             {"cube.msh:", "type 77"}),
    bad_mesh("gmsh_of_pyramids", gmsh2({{"1 4 2 7 1 1 2 3 7", "1 7 2 7 1 1 2 3 7 4"}}),
             {"cube.msh:", "pyramid"}),
    bad_mesh("gmsh_nan", gmsh2({{"3 1 1 0", "3 nan 1 0"}}), {"cube.msh:", "finite number"}),
    bad_mesh("gmsh_index_out_of_range", gmsh2({{"1 4 2 7 1 1 2 3 7", "1 4 2 7 1 1 2 3 9"}}),
             {"cube.msh:", "9"}),
    bad_mesh("gmsh_negative_index", gmsh2({{"1 4 2 7 1 1 2 3 7", "1 4 2 7 1 1 2 3 -7"}}),
             {"cube.msh:", "-7"}),
    bad_mesh("gmsh_duplicate_node", gmsh2({{"2 1 0 0", "1 1 0 0"}}), {"cube.msh:"}),
    bad_mesh("gmsh_repeated_corner", gmsh2({{"1 4 2 7 1 1 2 3 7", "1 4 2 7 1 1 2 2 7"}}), {"cube"}),
    bad_mesh("gmsh_huge_count", gmsh2({{"$Nodes\n8\n", "$Nodes\n8000000000000\n"}}), {"cube.msh:"}),
    bad_mesh("gmsh_of_triangles",
             gmsh2({{"6\n1 4 2 7 1 1 2 3 7\n2 4 2 7 1 1 3 4 7\n3 4 2 7 1 1 4 8 7\n4 4 2 7 1 1 8 5 7\n"
                     "5 4 2 7 1 1 5 6 7\n6 4 2 7 1 1 6 2 7\n",
                     "1\n1 2 2 7 1 1 2 3\n"}}),
             {"cube.msh", "volume cells"}),
    bad_mesh("all_inside_out",
             gmsh2({{"1 4 2 7 1 1 2 3 7\n2 4 2 7 1 1 3 4 7\n3 4 2 7 1 1 4 8 7\n4 4 2 7 1 1 8 5 7\n"
                     "5 4 2 7 1 1 5 6 7\n6 4 2 7 1 1 6 2 7\n",
                     "1 4 2 7 1 2 1 3 7\n2 4 2 7 1 3 1 4 7\n3 4 2 7 1 4 1 8 7\n4 4 2 7 1 8 1 5 7\n"
                     "5 4 2 7 1 5 1 6 7\n6 4 2 7 1 6 1 2 7\n"}}),
             {"negative", "evert mesh"}),
    bad_mesh(
        "misplaced_middle_nodes",
        {"cube.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0.5 0 0\n"
         "6 0.5 0.5 0\n7 0 0.5 0\n8 0 0 0.5\n9 0.5 0 0.5\n10 0 0.5 0.5\n$EndNodes\n$Elements\n1\n"
         "1 11 2 7 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n"},
        {"cube.msh: 1 of 1 cells have misplaced middle nodes", "23 before 13 in Gmsh"}),
    bad_mesh("one_flat", gmsh2({{"7 1 1 1", "7 1 1 0"}}), {"volume"}),
    {.name = "unknown_group",
     .files = {scene_with_mesh("cube.msh, groups: [skin]"), gmsh2()},
     .says = {"skin", "flesh"}},
    bad_mesh("medit_of_version_9", medit({{"Formatted 2", "Formatted 9"}}),
             {"cube.mesh:", "allowed are 1 to 4"}),
    bad_mesh("medit_flat", medit({{"Dimension 3", "Dimension 2"}}), {"cube.mesh:2", "dimension must be 3"}),
    bad_mesh("medit_index_out_of_range", medit({{"1 2 3 7 1", "1 2 3 0 1"}}), {"cube.mesh:", "vertex 0"}),
    bad_mesh("medit_without_cells", medit({{"Tetrahedra\n6", "Tetrahedra\n0"}}), {"cube.mesh"}),
};

/// Only sound states are in what a run that failed leaves behind: rows and frames from before.
void expect_sound_output(const fs::path& place) {
  std::ifstream log(place / "out/energy.csv");
  int rows = 0;
  for (std::string row; std::getline(log, row); ++rows)
    EXPECT_TRUE(row.find("nan") == std::string::npos && row.find("inf") == std::string::npos) << row;
  EXPECT_GT(rows, 2) << "a header, the start, and what was still sound";
  EXPECT_TRUE(fs::exists(place / "out/checkpoint.h5"));
  EXPECT_FALSE(fs::exists(place / "out/summary.json")) << "of the run before";
}

Case failing(const std::string& name, const std::vector<Edit>& edits, const std::vector<std::string>& says) {
  return {.name = name, .files = {scene(edits)}, .exit_code = 3, .says = says};
}

const std::vector<Case> failures{
    // Steps far beyond the stable one.
    {.name = "blows_up_undamped",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3",
     .command =
         "run scene.yaml -set end_time=100 -set integrator.time_step=0.2 "
         "-set output.frames_per_second=5 -set output.energy_log=0 -set checkpoint.every_simulated=0.2",
     .files = {scene({{"    damping: {model: rotated, stiffness_proportional: 0.01}\n", ""},
                      {"petsc: {damping_ksp_rtol: 1e-6}\n", ""},
                      {"gravity: [0, -9.81, 0]", "gravity: [0, 0, 0]"},
                      {"density: 1000", "density: 1000\n    spin: [1, 2, 3]"}})},
     .exit_code = 3,
     .says = {"the simulation failed: at t = ", "blown up", "turned round in each of the last",
              "first to look at is node", "of 'cube' on rank", "the step of 0.2 s is",
              "times the longest that is sure to be stable at rest", "a well-shaped tetrahedron",
              "try an integrator.time_step of "},
     .inspect = expect_sound_output},
    {.name = "keeps_the_last_good_checkpoint",
     .command = "run scene.yaml -set end_time=100 -set integrator.time_step=0.03 "
                "-set output.frames_per_second=null -set checkpoint.every_simulated=0.03",
     .files = {scene({{"    damping: {model: rotated, stiffness_proportional: 0.01}\n", ""},
                      {"petsc: {damping_ksp_rtol: 1e-6}\n", ""},
                      {"gravity: [0, -9.81, 0]", "gravity: [0, 0, 0]"},
                      {"density: 1000", "density: 1000\n    spin: [1, 2, 3]"}})},
     .exit_code = 3,
     .says = {"blown up", "s is kept: evert run scene.yaml -restart out/checkpoint.h5"}},
    {.name = "blows_up_damped",
     .command = "run scene.yaml -set end_time=100 -set output.frames_per_second=2 -set gravity=[0,0,0] "
                "-set integrator.time_step=0.5 "
                "-set bodies.cube.spin=[1,2,3] -set bodies.cube.material.youngs_modulus=1e9 "
                "-set bodies.cube.damping.stiffness_proportional=1e-6",
     .files = {scene()},
     .exit_code = 3,
     .says = {"the simulation failed: at t = ", "integrator.time_step"}},
    failing("overflowing_stiffness", {{"youngs_modulus: 1e5", "youngs_modulus: 1e300"}},
            {"the simulation failed: at t = 0 s, step 0"}),
    failing("overflowing_weight", {{"gravity: [0, -9.81, 0]", "gravity: [0, -1e308, 0]"}},
            {"at t = 0 s", "DIVERGED_NANORINF"}),
    failing("faster_than_light", {{"density: 1000", "density: 1000\n    velocity: [1e9, 0, 0]"}},
            {"at t = 0 s", "27 of 27 nodes", "faster than light"}),
    {.name = "steps_of_nothing",
     .command = "run scene.yaml -set integrator.safety=1e-300",
     .files = {scene()},
     .exit_code = 3,
     .says = {"at t = 0 s", "no time step that leads anywhere"}},
    {.name = "too_few_iterations",
     .command = "run scene.yaml -damping_ksp_max_it 1 -set bodies.cube.spin=[1,2,3]",
     .files = {scene()},
     .exit_code = 3,
     .says = {"at t = 0 s", "DIVERGED_ITS", "-damping_ksp_max_it"}},
};

const std::vector<Case> bad_output{
    {.name = "output_below_a_file",
     .command = "run scene.yaml -set output.directory=plain/out",
     .files = {scene(), {"plain", "a file\n"}},
     .says = {"plain"}},
    {.name = "output_is_a_file",
     .command = "run scene.yaml -set output.directory=plain",
     .files = {scene(), {"plain", "a file\n"}},
     .says = {"plain"}},
    bad_command("output_in_proc", "run scene.yaml -set output.directory=/proc/out", {"/proc/out"}),
    {.name = "disk_full",
     .command = "run scene.yaml -set output.directory=disk/out -set bodies.cube.mesh.cells=[8,8,8]",
     .files = {scene()},
     .disk_kib = 64,
     .says = {"disk/out"}},
};

const std::vector<Case> bad_restarts{
    bad_restart("restart_from_nothing",
                [](const fs::path& place) { fs::remove(place / "out/checkpoint.h5"); },
                {"there is no checkpoint", "checkpoint.h5"}),
    bad_restart("restart_from_a_directory",
                [](const fs::path& place) {
                  fs::remove(place / "out/checkpoint.h5");
                  fs::create_directory(place / "out/checkpoint.h5");
                },
                {"checkpoint.h5"}),
    bad_restart("restart_from_empty", [](const fs::path& place) { truncate(place / "out/checkpoint.h5", 0); },
                {"checkpoint.h5"}),
    bad_restart("restart_from_a_third",
                [](const fs::path& place) { truncate(place / "out/checkpoint.h5", 0.3); }, {"checkpoint.h5"}),
    bad_restart("restart_from_all_but_the_end",
                [](const fs::path& place) { truncate(place / "out/checkpoint.h5", 0.98); },
                {"checkpoint.h5"}),
    bad_restart("restart_from_text",
                [](const fs::path& place) { std::ofstream(place / "out/checkpoint.h5") << "not HDF5\n"; },
                {"checkpoint.h5"}),
    bad_restart(
        "restart_of_another_mesh",
        [](const fs::path& place) {
          std::ofstream(place / "scene.yaml") << scene({{"cells: [2, 2, 2]", "cells: [3, 2, 2]"}}).content;
        },
        {"checkpoint.h5", "another scene"}),
    bad_restart("restart_of_another_material",
                [](const fs::path& place) {
                  std::ofstream(place / "scene.yaml")
                      << scene({{"youngs_modulus: 1e5", "youngs_modulus: 2e5"}}).content;
                },
                {"checkpoint.h5", "another scene"}),
};

/// Meshes that end after every tenth of their bytes.
std::vector<Case> cut_meshes() {
  std::vector<Case> cases;
  for (int tenths = 0; tenths < 10; ++tenths) {
    const auto percent = std::to_string(10 * tenths);
    cases.push_back(bad_mesh("gmsh_cut_at_" + percent + "_percent", cut(gmsh4(), tenths), {"cube.msh"}));
    cases.push_back(bad_mesh("medit_cut_at_" + percent + "_percent", cut(medit(), tenths), {"cube.mesh"}));
    cases.back().ranks = {1};
  }
  return cases;
}

}  // namespace

const std::vector<Case>& all_cases() {
  static const auto cases = [] {
    std::vector<Case> all;
    for (const auto& group : {good_runs,         views,
                              material_cases(),  quasistatic_cases(),
                              explicit_cases(),  plasticity_cases(),
                              stability_cases(), extremes_cases(),
                              filter_cases(),    mass_cases(),
                              shape_cases(),     bad_mesh_cases(),
                              motion_cases(),    rigid_cases(),
                              bad_commands,      bad_scenes,
                              bad_meshes,        cut_meshes(),
                              fibre_cases(),     failures,
                              bad_output,        bad_restarts,
                              trade_cases()})
      all.insert(all.end(), group.begin(), group.end());
    return all;
  }();
  return cases;
}

}  // namespace evert::cli
