#include "case.hpp"

/// Cases of obstacles with a mass.
namespace evert::cli {
namespace {

/// The scene with a ball as well.
File scene_with_ball(const std::string& keys) {
  return scene(
      {{"petsc:", "  ball: {shape: sphere, center: [0.5, 1.4, 0.5], radius: 0.4" + keys + "}\npetsc:"}});
}

Case bad_ball(const std::string& name, const std::string& keys, const std::vector<std::string>& says) {
  return {.name = name, .files = {scene_with_ball(keys)}, .says = says};
}

const std::vector<Case> cases{
    {.name = "rigid_body",
     .files = {scene_with_ball(", mass: 2, friction: 0.3, initial_velocity: [0, -1, 0]")},
     .exit_code = 0,
     .says = {"finished at t = 0.002 s"}},
    {.name = "rigid_body_goes_on",
     .before = "run scene.yaml -set checkpoint.every_simulated=1e-3 -set output.energy_log=1e-3",
     .command = "run scene.yaml --restart out/checkpoint.h5 -set end_time=4e-3 -set output.energy_log=1e-3",
     .files = {scene_with_ball(", density: 200")},
     .exit_code = 0,
     .says = {"finished at t = 0.004 s"}},
    {.name = "rigid_body_check",
     .command = "check scene.yaml",
     .files = {scene_with_ball(", density: 1000")},
     .exit_code = 0,
     .says = {"ball: sphere, friction 0, a rigid body of 268.083 kg"}},
    bad_ball("rigid_mass_negative", ", mass: -1", {"obstacles.ball.mass: '-1' is not allowed: must be > 0"}),
    bad_ball("rigid_mass_zero", ", mass: 0", {"obstacles.ball.mass: '0' is not allowed: must be > 0"}),
    bad_ball("rigid_density_zero", ", density: 0",
             {"obstacles.ball.density: '0' is not allowed: must be > 0"}),
    bad_ball("rigid_mass_not_finite", ", mass: .nan", {"obstacles.ball.mass", "must be finite"}),
    bad_ball("rigid_mass_and_density", ", mass: 1, density: 1000",
             {"obstacles.ball.mass: excludes 'density'"}),
    bad_ball("rigid_mass_and_velocity", ", mass: 1, velocity: [0, 1, 0]",
             {"obstacles.ball.mass: excludes 'velocity'", "'initial_velocity'"}),
    bad_ball("rigid_mass_and_motion", ", mass: 1, motion: {velocity: [0, 1, 0]}",
             {"obstacles.ball.mass: excludes 'motion'"}),
    bad_ball("rigid_mass_and_until", ", mass: 1, until: 2",
             {"obstacles.ball.mass: excludes 'until': what has a mass stays"}),
    bad_ball("rigid_initial_velocity_without_mass", ", initial_velocity: [0, 1, 0]",
             {"obstacles.ball.initial_velocity: goes with 'mass' or 'density' only"}),
    bad_ball("rigid_initial_velocity_of_two", ", mass: 1, initial_velocity: [0, 1]",
             {"obstacles.ball.initial_velocity", "3 numbers"}),
    {.name = "rigid_half_space",
     .files = {scene({{"friction: 0.4", "friction: 0.4, mass: 5"}})},
     .says = {"scene.yaml:12: obstacles.ground.mass: is not possible: a half_space goes on for ever"}},
    {.name = "rigid_too_light",
     .files = {scene_with_ball(", mass: 1e-320")},
     .says = {"obstacles.ball", "mass"}},
};

}  // namespace

std::vector<Case> rigid_cases() { return cases; }

}  // namespace evert::cli
