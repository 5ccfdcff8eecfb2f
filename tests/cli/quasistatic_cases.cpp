#include "case.hpp"
#include <fstream>

/// Cases of `integrator: {method: quasistatic}`.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;

/// The cube without obstacle, held at one side, at rest under its weight.
File quasistatic_scene(const std::vector<Edit>& edits = {}) {
  std::vector<Edit> all{
      {"obstacles:\n  ground: {shape: half_space, normal: [0, 1, 0], point: [0, -1, 0], friction: 0.4}\n",
       "constraints: [{body: cube, node_set: x_min, fixed: true}]\nintegrator: {method: quasistatic}\n"},
      {"petsc: {damping_ksp_rtol: 1e-6}\n", ""}};
  all.insert(all.end(), edits.begin(), edits.end());
  return scene(all);
}

Case bad_quasistatic(const std::string& name, const std::string& command,
                     const std::vector<std::string>& says) {
  return {.name = name, .command = command, .files = {quasistatic_scene()}, .says = says};
}

Case bad_command(const std::string& name, const std::string& command, const std::vector<std::string>& says) {
  return {.name = name, .command = command, .files = {scene()}, .says = says};
}

const std::vector<Case> cases{
    {.name = "quasistatic",
     .files = {quasistatic_scene()},
     .exit_code = 0,
     .says = {"finished at t = 0.002 s, 2 steps"}},
    {.name = "quasistatic_check",
     .command = "check scene.yaml",
     .files = {quasistatic_scene()},
     .exit_code = 0,
     .says = {"one load step from stop to stop"}},
    {.name = "quasistatic_options_of_the_solve",
     .command =
         "run scene.yaml -quasistatic_snes_monitor -quasistatic_snes_converged_reason "
         "-quasistatic_ksp_converged_reason -quasistatic_snes_view -quasistatic_snes_linesearch_monitor",
     .files = {quasistatic_scene()},
     .exit_code = 0,
     .says = {"SNES Function norm", "Nonlinear quasistatic_ solve converged",
              "Linear quasistatic_ solve converged"}},
    {.name = "quasistatic_blocks",
     .command = "run scene.yaml -quasistatic_mat_type sbaij -quasistatic_pc_type bjacobi "
                "-quasistatic_sub_pc_type icc",
     .files = {quasistatic_scene()},
     .exit_code = 0},
    {.name = "quasistatic_from_a_motion",
     .before = "run scene.yaml -set integrator.method=newmark -set checkpoint.every_simulated=1e-3",
     .command = "run scene.yaml --restart out/checkpoint.h5 -set end_time=3e-3",
     .files = {quasistatic_scene()},
     .exit_code = 0},
    bad_quasistatic("quasistatic_option_of_damping", "run scene.yaml -damping_ksp_rtol 1e-6",
                    {"-damping_ksp_rtol: has no effect", "quasistatic"}),
    bad_quasistatic("quasistatic_unknown_option", "run scene.yaml -quasistatic_snes_rtoll 1e-6",
                    {"quasistatic_snes_rtoll", "did you mean '-quasistatic_snes_rtol'?"}),
    bad_quasistatic("quasistatic_option_without_value", "run scene.yaml -quasistatic_snes_rtol",
                    {"-quasistatic_snes_rtol: needs a value"}),
    bad_quasistatic("quasistatic_tolerance_of_nothing", "run scene.yaml -quasistatic_snes_rtol 2",
                    {"-quasistatic_snes_rtol is not allowed: must be in [0, 1)"}),
    bad_quasistatic("quasistatic_unknown_method", "run scene.yaml -quasistatic_snes_type newton", {"newton"}),
    bad_quasistatic("quasistatic_method_of_grids", "run scene.yaml -quasistatic_snes_type fas",
                    {"-quasistatic_snes_type fas is not allowed: must be newtonls, newtontr or qn"}),
    bad_quasistatic("quasistatic_shell", "run scene.yaml -quasistatic_mat_type shell",
                    {"-quasistatic_mat_type shell is not allowed: must be aij, baij or sbaij"}),
    bad_quasistatic("quasistatic_gamg_of_blocks",
                    "run scene.yaml -quasistatic_mat_type baij -quasistatic_pc_type gamg",
                    {"-quasistatic_pc_type gamg does not work with -quasistatic_mat_type baij: must be aij"}),
    bad_quasistatic("quasistatic_option_of_the_automatic_step", "run scene.yaml -set integrator.safety=0.5",
                    {"integrator.safety", "has no effect", "newmark"}),
    bad_quasistatic("quasistatic_no_load_steps", "run scene.yaml -set integrator.load_steps=0",
                    {"integrator.load_steps", "0"}),
    bad_quasistatic("quasistatic_unknown_tangent", "run scene.yaml -set integrator.tangent=secant",
                    {"integrator.tangent", "adaptive"}),
    bad_command("quasistatic_obstacle", "run scene.yaml -set integrator.method=quasistatic",
                {"scene.yaml", "obstacles", "quasistatic", "no contact"}),
    bad_quasistatic("quasistatic_falls", "run scene.yaml -set constraints=[]",
                    {"bodies.cube: falls for ever", "constraints"}),
    bad_command("quasistatic_option_of_a_motion", "run scene.yaml -quasistatic_snes_rtol 1e-6",
                {"-quasistatic_snes_rtol: has no effect", "not quasistatic"}),
    {.name = "quasistatic_finds_no_rest",
     .command = "run scene.yaml -quasistatic_snes_max_it 1 -quasistatic_snes_rtol 1e-14",
     .files = {quasistatic_scene()},
     .exit_code = 3,
     .says = {"the simulation failed: at t = 0 s, step 0: no state of rest was found (DIVERGED_MAX_IT)",
              "1024 times smaller load steps", "integrator.load_steps"}},
};

}  // namespace

std::vector<Case> quasistatic_cases() { return cases; }

}  // namespace evert::cli
