#include "case.hpp"

/// Cases of `obstacles.<name>.motion`.
namespace evert::cli {
namespace {

/// The ground with this motion.
File moving_scene(const std::string& motion) { return scene({{"friction: 0.4", "motion: " + motion}}); }

Case good_motion(const std::string& name, const std::string& motion, std::vector<File> more = {}) {
  more.push_back(moving_scene(motion));
  return {.name = name, .files = more, .exit_code = 0, .says = {"finished at t = 0.002 s"}};
}

Case bad_motion(const std::string& name, const std::string& motion, const std::vector<std::string>& says,
                std::vector<File> more = {}) {
  more.push_back(moving_scene(motion));
  return {.name = name, .files = more, .says = says};
}

/// A table of that text beside the scene.
Case bad_table(const std::string& name, const std::string& table, const std::vector<std::string>& says) {
  return bad_motion(name, "{file: lift.csv}", says, {{"lift.csv", table}});
}

const std::vector<Case> cases{
    good_motion("motion_steady", "{velocity: [1, 0, 0], angular_velocity: [0, 2, 0], about: [0.5, 0, 0]}"),
    good_motion("motion_by_keyframes", "{keyframes: [[0, 0, 0, 0, 1, 0, 0, 0], [1, 0, 1, 0, 0, 1, 0, 0]]}"),
    good_motion("motion_to_and_fro", "{frequency: 2, amplitude: [0, 0.1, 0], angle: [0, 0, 0.1], phase: 1}"),
    good_motion("motion_by_file", "{file: lift.csv}",
                {{"lift.csv",
                  "t, x, y, z, w, x, y, z\n# at rest\n0,0,0,0,1,0,0,0\n\n 1, 0, .5, 0, 0.6, 0.8, 0, 0\r\n"}}),
    {.name = "motion_check",
     .command = "check scene.yaml",
     .files = {moving_scene("{angular_velocity: [0, 2, 0]}")},
     .exit_code = 0,
     .says = {"ground: half_space"}},
    bad_motion("motion_of_nothing", "{about: [0, 0, 0]}",
               {"obstacles.ground.motion: needs 'velocity' or 'angular_velocity', 'keyframes', 'file', or "
                "'frequency'"}),
    bad_motion(
        "motion_of_two_kinds", "{velocity: [1, 0, 0], file: lift.csv}",
        {"scene.yaml:12: obstacles.ground.motion.file: is of a table, but 'velocity' of a steady motion"}),
    bad_motion("motion_twice", "{velocity: [1, 0, 0]}, velocity: [1, 0, 0]",
               {"obstacles.ground.motion: excludes 'velocity': write 'motion: {velocity: ...}'"}),
    bad_motion("motion_misspelt", "{angular_velocty: [1, 0, 0]}", {"did you mean 'angular_velocity'?"}),
    bad_motion("motion_without_frequency", "{amplitude: [1, 0, 0]}", {"'frequency' is missing [Hz]"}),
    bad_motion("motion_without_amplitude", "{frequency: 1}", {"needs 'amplitude' [m] or 'angle' [rad]"}),
    bad_motion("motion_of_no_frequency", "{frequency: 0, amplitude: [1, 0, 0]}",
               {"obstacles.ground.motion.frequency", "must be > 0"}),
    bad_motion("motion_not_finite", "{velocity: [.inf, 0, 0]}",
               {"obstacles.ground.motion.velocity[0]", "must be finite"}),
    bad_motion("motion_quaternion_not_unit",
               "{keyframes: [[0, 0, 0, 0, 1, 0, 0, 0], [1, 0, 1, 0, 1, 0.01, 0, 0]]}",
               {"obstacles.ground.motion.keyframes[1]", "length 1.00005", "must be 1 within 1e-6"}),
    bad_motion(
        "motion_keyframes_out_of_order", "{keyframes: [[1, 0, 0, 0, 1, 0, 0, 0], [1, 0, 1, 0, 1, 0, 0, 0]]}",
        {"obstacles.ground.motion.keyframes[1]", "a time that is not later than that of the row before"}),
    bad_motion("motion_keyframe_too_short", "{keyframes: [[0, 0, 0, 0]]}",
               {"obstacles.ground.motion.keyframes[0]", "8 numbers t, x, y, z, w, x, y, z"}),
    bad_motion("motion_without_keyframes", "{keyframes: []}",
               {"obstacles.ground.motion.keyframes: must have one row at least"}),
    bad_motion("motion_file_missing", "{file: nowhere.csv}", {"nowhere.csv: there is no such file"}),
    bad_motion("motion_file_is_a_directory", "{file: lift.csv}", {"lift.csv: is not a regular file"},
               {{"lift.csv/"}}),
    bad_table("motion_file_empty", "# nothing\n", {"lift.csv: has no rows"}),
    bad_table("motion_file_of_words", "0,0,0,0,1,0,0,0\n1,0,up,0,1,0,0,0\n",
              {"lift.csv:2: must be 8 finite numbers", "number 3 is none"}),
    bad_table("motion_file_not_finite", "0,0,0,nan,1,0,0,0\n", {"lift.csv:1:", "number 4 is none"}),
    bad_table("motion_file_too_short", "0,0,0,0,1,0,0\n", {"lift.csv:1: must be 8 numbers between commas"}),
    bad_table("motion_file_too_long", "0,0,0,0,1,0,0,0,0\n",
              {"lift.csv:1: must be 8 numbers between commas"}),
    bad_table("motion_file_out_of_order", "0,0,0,0,1,0,0,0\n-1,0,0,0,1,0,0,0\n",
              {"lift.csv:2: has a time that is not later than that of the row before"}),
    bad_table("motion_file_not_unit", "0,0,0,0,0,0,0,0\n", {"lift.csv:1: has a quaternion", "length 0"}),
    {.name = "friction_negative",
     .files = {scene({{"friction: 0.4", "friction: -0.4"}})},
     .says = {"obstacles.ground.friction: '-0.4' is not allowed: must be >= 0"}},
};

}  // namespace

std::vector<Case> motion_cases() { return cases; }

}  // namespace evert::cli
