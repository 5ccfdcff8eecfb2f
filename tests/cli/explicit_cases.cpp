#include "case.hpp"

/// Cases of the methods that take damping explicitly.
namespace evert::cli {
namespace {

const std::string without_petsc_block = "petsc: {damping_ksp_rtol: 1e-6}\n";

/// The scene with a ball that has a mass.
Case with_ball(const std::string& name, const std::string& method, const std::vector<std::string>& says,
               int exit_code) {
  return {.name = name,
          .command = "run scene.yaml -set integrator.time_step=1e-5 -set integrator.method=" + method,
          .files = {scene({{without_petsc_block,
                            "  ball: {shape: sphere, center: [0.5, 1.4, 0.5], radius: 0.4, mass: 2, "
                            "friction: 0.3, initial_velocity: [0, -1, 0]}\n"}})},
          .exit_code = exit_code,
          .says = says};
}

Case with_method(const std::string& name, const std::string& method, const std::string& more,
                 const std::vector<std::string>& says, int exit_code = 2) {
  return {.name = name,
          .command = "run scene.yaml -set integrator.method=" + method + more,
          .files = {scene({{without_petsc_block, ""}})},
          .exit_code = exit_code,
          .says = says};
}

const std::vector<Case> cases{
    with_method("verlet", "verlet", "", {"finished at t = 0.002 s"}, 0),
    with_method("symplectic_euler", "symplectic_euler", "", {"finished at t = 0.002 s"}, 0),
    with_method("explicit_euler", "explicit_euler", " -set integrator.time_step=1e-5",
                {"finished at t = 0.002 s"}, 0),
    with_method("verlet_load_steps", "verlet", " -set integrator.load_steps=2",
                {"integrator.load_steps", "has no effect", "quasistatic"}),
    with_method("explicit_euler_auto", "explicit_euler", "",
                {"integrator.time_step: must be a number of seconds", "explicit_euler"}),
    with_method(
        "explicit_method_unknown", "symplectic", "",
        {"integrator.method", "must be newmark, verlet, symplectic_euler, explicit_euler or quasistatic"}),
    with_method("verlet_consistent", "verlet", " -set obstacles=null -set integrator.mass=consistent",
                {"integrator.mass: 'consistent'", "'method: newmark' only"}),
    with_ball("verlet_rigid_body", "verlet", {"finished at t = 0.002 s"}, 0),
    with_ball("symplectic_euler_rigid_body", "symplectic_euler",
              {"obstacles.ball.mass: a rigid body with a mass", "'verlet' only"}, 2),
    with_ball("explicit_euler_rigid_body", "explicit_euler",
              {"obstacles.ball.mass: a rigid body with a mass", "'verlet' only"}, 2),
    with_method("explicit_method_and_damping_option", "verlet", " -damping_ksp_rtol 1e-6",
                {"-damping_ksp_rtol: has no effect", "explicitly"}),
};

}  // namespace

std::vector<Case> explicit_cases() { return cases; }

}  // namespace evert::cli
