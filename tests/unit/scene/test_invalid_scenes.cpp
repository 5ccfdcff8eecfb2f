#include <gtest/gtest.h>

#include "scenes.hpp"
#include <algorithm>

/// One line of a valid scene is broken; the message must name the line, the key and what is allowed.
namespace evert {
namespace {

struct Mistake {
  std::string name;
  std::string right, wrong;  ///< what stands in the scene, and what replaces it
  std::string message;       ///< the whole sentence
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

const std::vector<Mistake> mistakes{
    // missing keys
    {"no_name", "name: full\n", "", "scene.yaml:1: 'name' is missing, e.g. name: torus puddle"},
    {"no_end_time", "end_time: 2\n", "", "scene.yaml:1: 'end_time' is missing [s], e.g. end_time: 2"},
    {"no_density", "    density: 1000\n", "",
     "scene.yaml:10: bodies.torus: 'density' is missing [kg/m^3], e.g. density: 1000"},
    {"no_radius", ", radius: 4", "",
     "scene.yaml:36: obstacles.ball: 'radius' is missing [m], e.g. radius: 0.5"},
    {"no_event_value", ", to: 2.0e5", "", "scene.yaml:42: events[0]: 'to' is missing, e.g. to: 2e5"},
    // unknown keys
    {"misspelt_key", "poissons_ratio: 0.45", "poisson_ratio: 0.45",
     "scene.yaml:20: bodies.torus.material.poisson_ratio: unknown key (did you mean 'poissons_ratio'?)"},
    {"misspelt_top_key",
     "gravity:", "gravitiy:", "scene.yaml:3: gravitiy: unknown key (did you mean 'gravity'?)"},
    {"foreign_key", "safety: 0.5", "color: red",
     "scene.yaml:43: integrator.color: unknown key; known here are method, mass, time_step, safety, "
     "max_strain_increment, load_steps, tangent or untangle"},
    {"misspelt_tag", "shape: sphere", "shpe: sphere",
     "scene.yaml:36: obstacles.ball.shpe: unknown key (did you mean 'shape'?)"},
    {"key_of_another_shape", "radius: 4", "radius: 4, normal: [0, 1, 0]",
     "scene.yaml:36: obstacles.ball.normal: does not go with 'shape: sphere'; known there are shape, radius, "
     "center, rotate, grow, friction, velocity, motion, until, mass, density, initial_velocity or "
     "initial_angular_velocity"},
    {"merge_key", "density: 1000", "<<: {density: 1000}",
     "scene.yaml:13: bodies.torus.<<: unknown key; known here are mesh, order, transform, "
     "density, velocity, spin, start, material, damping, fibres, activation, plasticity, mean_dilatation, "
     "precision or groups"},
    // duplicate keys
    {"duplicate_key", "density: 1000", "density: 1000\n    density: 1000",
     "scene.yaml:14: duplicate key 'density', first given at scene.yaml:13"},
    {"duplicate_body", "  box:\n", "  torus:\n",
     "scene.yaml:29: duplicate key 'torus', first given at scene.yaml:10"},
    {"duplicate_in_flow", "friction: 0.4", "friction: 0.4, friction: 0.4",
     "scene.yaml:35: duplicate key 'friction', first given at scene.yaml:35"},
    // types
    {"word_for_number", "density: 1000", "density: heavy",
     "scene.yaml:13: bodies.torus.density: 'heavy' is not allowed: must be a number"},
    {"quoted_number", "density: 1000", "density: \"1000\"",
     "scene.yaml:13: bodies.torus.density: '1000' is text in quotes: must be a number"},
    {"list_for_number", "density: 1000", "density: [1000]",
     "scene.yaml:13: bodies.torus.density: must be a number, not a list"},
    {"map_for_number", "density: 1000", "density: {is: 1000}",
     "scene.yaml:13: bodies.torus.density: must be a number, not a map of keys"},
    {"nothing_for_number", "density: 1000", "density:", "scene.yaml:13: bodies.torus.density: has no value"},
    {"tilde_for_number", "density: 1000", "density: ~", "scene.yaml:13: bodies.torus.density: has no value"},
    {"number_for_map", "checkpoint: {every_simulated: 0.5, every_wall: 600}", "checkpoint: 600",
     "scene.yaml:44: checkpoint: must be a map of keys, not '600'"},
    {"list_for_bodies", "events:\n  - {at", "events: {}\nobstacle:\n  - {at",
     "scene.yaml:42: obstacle: unknown key (did you mean 'obstacles'?)"},
    {"map_for_list", "fields: [velocity, rank]", "fields: {velocity: rank}",
     "scene.yaml:7: output.fields: must be a list, not a map of keys"},
    {"yes_for_true", "fixed: true", "fixed: yes",
     "scene.yaml:38: constraints[0].fixed: 'yes' is not allowed: must be true or false"},
    {"half_a_cell", "cells: [1, 2, 3]", "cells: [1, 2.5, 3]",
     "scene.yaml:30: bodies.box.mesh.cells[1]: '2.5' is not allowed: must be a whole number from 1 to "
     "1000000"},
    {"decimal_comma", "density: 1000", "density: 1,5",
     "scene.yaml:13: bodies.torus.density: '1,5' is not allowed: must be a number"},
    // lengths of lists
    {"two_for_vector", "gravity: [0, -9.81, 0]", "gravity: [0, -9.81]",
     "scene.yaml:3: gravity: must be a list of 3 numbers, not of 2"},
    {"four_for_vector", "gravity: [0, -9.81, 0]", "gravity: [0, -9.81, 0, 0]",
     "scene.yaml:3: gravity: must be a list of 3 numbers, not of 4"},
    {"number_for_vector", "gravity: [0, -9.81, 0]", "gravity: -9.81",
     "scene.yaml:3: gravity: must be a list of 3 numbers, not '-9.81'"},
    {"word_in_vector", "gravity: [0, -9.81, 0]", "gravity: [0, down, 0]",
     "scene.yaml:3: gravity[1]: 'down' is not allowed: must be a number"},
    {"short_keyframe", "[1, 0, 0.5, 0]", "[1, 0, 0.5]",
     "scene.yaml:40: constraints[2].velocity[1]: must be a list of 4 numbers t, vx, vy, vz, not of 3"},
    // ranges
    {"impossible_ratio", "poissons_ratio: 0.45", "poissons_ratio: 0.5",
     "scene.yaml:20: bodies.torus.material.poissons_ratio: '0.5' is not allowed: must be in (-1, 0.5)"},
    {"negative_ratio", "poissons_ratio: 0.45", "poissons_ratio: -1",
     "scene.yaml:20: bodies.torus.material.poissons_ratio: '-1' is not allowed: must be in (-1, 0.5)"},
    {"negative_stiffness", "youngs_modulus: 1.0e5", "youngs_modulus: -1",
     "scene.yaml:19: bodies.torus.material.youngs_modulus: '-1' is not allowed: must be >= 0"},
    {"no_mass", "density: 1000", "density: 0",
     "scene.yaml:13: bodies.torus.density: '0' is not allowed: must be > 0"},
    {"negative_friction", "friction: 0.4", "friction: -0.4",
     "scene.yaml:35: obstacles.ground.friction: '-0.4' is not allowed: must be >= 0"},
    {"safety_above_one", "safety: 0.5", "safety: 1.5",
     "scene.yaml:43: integrator.safety: '1.5' is not allowed: must be in (0, 1]"},
    {"backward_time", "end_time: 2", "end_time: -2",
     "scene.yaml:2: end_time: '-2' is not allowed: must be > 0"},
    {"negative_seed", "seed: 7", "seed: -7",
     "scene.yaml:16: bodies.torus.start.seed: '-7' is not allowed: must be a whole number from 0 to "
     "1000000000000000000"},
    {"future_version", "name: full\n", "name: full\nschema_version: 2\n",
     "scene.yaml:2: schema_version: '2' is not allowed: must be a whole number from 1 to 1"},
    // not finite, not representable
    {"not_a_number", "density: 1000", "density: .nan",
     "scene.yaml:13: bodies.torus.density: '.nan' is not allowed: must be finite"},
    {"infinite", "density: 1000", "density: .inf",
     "scene.yaml:13: bodies.torus.density: '.inf' is not allowed: must be finite"},
    {"nan_word", "density: 1000", "density: nan",
     "scene.yaml:13: bodies.torus.density: 'nan' is not allowed: must be finite"},
    {"too_large", "density: 1000", "density: 1e999",
     "scene.yaml:13: bodies.torus.density: '1e999' does not fit into a double-precision number"},
    {"infinite_gravity", "-9.81", "-.inf",
     "scene.yaml:3: gravity[1]: '-.inf' is not allowed: must be finite"},
    // units
    {"spaced_unit", "radius: 4", "radius: 5 cm",
     "scene.yaml:36: obstacles.ball.radius: '5 cm' has a unit: write the SI number alone [m]"},
    {"joined_unit", "density: 1000", "density: 1g/cm3",
     "scene.yaml:13: bodies.torus.density: '1g/cm3' has a unit: write the SI number alone [kg/m^3]"},
    {"percent", "friction: 0.4", "friction: 40%",
     "scene.yaml:35: obstacles.ground.friction: '40%' has a unit: write the SI number alone"},
    {"degree_sign", "angle: 90", "angle: 90°",
     "scene.yaml:12: bodies.torus.transform.rotate.angle: '90°' has a unit: write the SI number alone "
     "[degrees]"},
    // words
    {"unknown_model", "model: neo_hookean", "model: neohookean",
     "scene.yaml:18: bodies.torus.material.model: 'neohookean' is not allowed: must be neo_hookean, "
     "rotated_linear, st_venant_kirchhoff, mooney_rivlin, spline, stable_neo_hookean, muscle or tendon (did "
     "you mean 'neo_hookean'?)"},
    {"unknown_shape", "shape: sphere", "shape: potato",
     "scene.yaml:36: obstacles.ball.shape: 'potato' is not allowed: must be half_space, sphere, box, "
     "rounded_box, "
     "ellipsoid, capsule, cylinder, torus, cone, gear, figure, mesh, union, intersection or difference"},
    {"unknown_generator", "generate: torus", "generate: tours",
     "scene.yaml:11: bodies.torus.mesh.generate: 'tours' is not allowed: must be box, ball, rounded_box, "
     "ellipsoid, capsule, cylinder, torus, cone, gear, figure, mesh, union, intersection, difference, "
     "round_bar, wedge_stack, "
     "cut_cube or sliver_ball (did "
     "you mean 'torus'?)"},
    {"unknown_field", "fields: [velocity, rank]", "fields: [velocity, ranks]",
     "scene.yaml:7: output.fields[1]: 'ranks' is not allowed: must be velocity, min_stretch, inversion, "
     "rank, plastic_strain or plastic_volume (did you "
     "mean 'rank'?)"},
    {"list_for_word", "model: neo_hookean", "model: [neo_hookean]",
     "scene.yaml:18: bodies.torus.material.model: must be neo_hookean, rotated_linear, "
     "st_venant_kirchhoff, mooney_rivlin, spline, stable_neo_hookean, muscle or tendon, not a list"},
    // several keys together
    {"no_shape", "{shape: sphere, ", "{",
     "scene.yaml:36: obstacles.ball: needs one of 'shape: half_space, shape: sphere, shape: box, "
     "shape: rounded_box, shape: ellipsoid, shape: capsule, shape: cylinder, shape: torus, shape: cone, "
     "shape: gear, shape: figure, shape: mesh, shape: union, shape: intersection or shape: difference'"},
    {"two_selections", "node_set: x_min,", "node_set: x_min, sphere: {center: [0, 0, 0], radius: 1},",
     "scene.yaml:38: constraints[0]: 'node_set' and 'sphere' exclude each other"},
    {"no_selection", "node_set: x_min, ", "",
     "scene.yaml:38: constraints[0]: needs one of 'node_set, box or sphere'"},
    {"two_meshes", "generate: torus,", "file: a.msh, generate: torus,",
     "scene.yaml:11: bodies.torus.mesh: 'file' and 'generate: torus' exclude each other"},
    {"fat_torus", "minor_radius: 0.2", "minor_radius: 0.5",
     "scene.yaml:11: bodies.torus.mesh: minor_radius is 0.5, but must be less than major_radius, 0.5"},
    {"empty_box", "max: [1, 2, 3]", "max: [1, 0, 3]",
     "scene.yaml:30: bodies.box.mesh.max: must exceed min, but does not along y"},
    {"box_without_corner", "max: [1, 2, 3], ", "",
     "scene.yaml:30: bodies.box.mesh: needs either 'size' (centred at the origin) or both 'min' and 'max'"},
    {"box_in_two_ways", "cells: [1, 2, 3]", "cells: [1, 2, 3], edge_length: 1",
     "scene.yaml:30: bodies.box.mesh: needs either 'cells' or 'edge_length'"},
    {"too_many_cells", "cells: [1, 2, 3]", "cells: [100000, 100000, 3]",
     "scene.yaml:30: bodies.box.mesh.cells: are too many: at most 1e9 in all"},
    {"too_fine", "edge_length: 0.1", "edge_length: 1e-6",
     "scene.yaml:11: bodies.torus.mesh.edge_length: '1e-6' is too short for this size: it makes more than "
     "1e9 cells"},
    {"damping_in_two_ways", "stiffness_proportional: 1.0e-3", "stiffness_proportional: 1.0e-3, beta: 1",
     "scene.yaml:23: bodies.torus.damping: needs one of 'stiffness_proportional' [s], 'stiffness_ratio' "
     "at a 'frequency' [Hz], and 'alpha' and 'beta' [Pa s]"},
    {"damping_of_nothing", ", stiffness_proportional: 1.0e-3", "",
     "scene.yaml:23: bodies.torus.damping: needs one of 'stiffness_proportional' [s], 'stiffness_ratio' "
     "at a 'frequency' [Hz], and 'alpha' and 'beta' [Pa s]"},
    {"damping_by_ratio_and_time", "stiffness_proportional: 1.0e-3",
     "stiffness_proportional: 1.0e-3, stiffness_ratio: 0.1, frequency: 2",
     "scene.yaml:23: bodies.torus.damping: needs one of 'stiffness_proportional' [s], 'stiffness_ratio' "
     "at a 'frequency' [Hz], and 'alpha' and 'beta' [Pa s]"},
    {"ratio_without_frequency", "stiffness_proportional: 1.0e-3", "stiffness_ratio: 0.1",
     "scene.yaml:23: bodies.torus.damping: needs the 'frequency' [Hz] that its damping ratio is meant at"},
    {"frequency_without_ratio", "stiffness_proportional: 1.0e-3",
     "stiffness_proportional: 1.0e-3, frequency: 2",
     "scene.yaml:23: bodies.torus.damping.frequency: goes with 'stiffness_ratio' or 'mass_ratio', and none "
     "is "
     "there"},
    {"mass_damping_in_two_ways", "stiffness_proportional: 1.0e-3",
     "stiffness_proportional: 1.0e-3, mass_proportional: 1, mass_ratio: 0.1, frequency: 2",
     "scene.yaml:23: bodies.torus.damping: may have 'mass_proportional' [1/s] or 'mass_ratio', not both"},
    {"limit_without_extension", "model: neo_hookean", "model: rotated_linear",
     "scene.yaml:21: bodies.torus.material.compression_limit: does not go with 'model: rotated_linear', only "
     "with neo_hookean, st_venant_kirchhoff, mooney_rivlin, spline, muscle or tendon"},
    {"constant_of_another_model", "compression_limit: 0.3", "mu_01_share: 0.3",
     "scene.yaml:21: bodies.torus.material.mu_01_share: does not go with 'model: neo_hookean', only with "
     "mooney_rivlin, muscle or tendon"},
    {"elongation_of_another_model", "compression_limit: 0.3", "elongation_limit: 2",
     "scene.yaml:21: bodies.torus.material.elongation_limit: does not go with 'model: neo_hookean', only "
     "with "
     "spline"},
    {"moduli_in_two_ways", "compression_limit: 0.3", "mu: 1e5",
     "scene.yaml:17: bodies.torus.material: needs either 'youngs_modulus' [Pa] and 'poissons_ratio' [-], or "
     "'lambda' and 'mu' [Pa]"},
    {"half_of_the_moduli", "      poissons_ratio: 0.45\n", "",
     "scene.yaml:17: bodies.torus.material: needs either 'youngs_modulus' [Pa] and 'poissons_ratio' [-], or "
     "'lambda' and 'mu' [Pa]"},
    {"no_moduli_of_rubber", "{model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}",
     "{model: mooney_rivlin, mu_10: 1, mu_01: 1}",
     "scene.yaml:32: bodies.box.material: needs either 'youngs_modulus' [Pa] and 'poissons_ratio' [-], or "
     "'lambda' and 'mu' [Pa], or 'mu_10', 'mu_01' and 'bulk_modulus' [Pa]"},
    {"rubber_without_shape", "{model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}",
     "{model: mooney_rivlin, mu_10: 0, mu_01: 0, bulk_modulus: 1}",
     "scene.yaml:32: bodies.box.material.mu_10: '0' is not allowed: mu_10 and mu_01 must not both be 0"},
    {"share_said_twice", "{model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}",
     "{model: mooney_rivlin, mu_10: 1, mu_01: 0, bulk_modulus: 1, mu_01_share: 0.5}",
     "scene.yaml:32: bodies.box.material.mu_01_share: '0.5' is not allowed: mu_01 says it already"},
    {"auxetic_beyond", "{model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}",
     "{model: rotated_linear, lambda: -2, mu: 3}",
     "scene.yaml:32: bodies.box.material.lambda: '-2' is not allowed: must be > -2/3 mu, or compression "
     "meets "
     "no resistance"},
    {"limit_at_the_end", "compression_limit: 0.3", "compression_limit: 0",
     "scene.yaml:21: bodies.torus.material.compression_limit: '0' is not allowed: must be in (0, 1) with "
     "'model: neo_hookean'"},
    {"limit_outside", "compression_limit: 0.3", "compression_limit: 1.5",
     "scene.yaml:21: bodies.torus.material.compression_limit: '1.5' is not allowed: must be in [0, 1]"},
    {"limits_in_wrong_order", "{model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}",
     "{model: spline, youngs_modulus: 1, poissons_ratio: 0, compression_limit: 0.8, elongation_limit: 0.7}",
     "scene.yaml:32: bodies.box.material.elongation_limit: '0.7' is not allowed: must be >= 1"},
    {"extension_of_a_spline", "{model: rotated_linear, youngs_modulus: 0, poissons_ratio: 0}",
     "{model: spline, youngs_modulus: 1, poissons_ratio: 0, extension: linear}",
     "scene.yaml:32: bodies.box.material.extension: does not go with 'model: spline', only with neo_hookean, "
     "st_venant_kirchhoff or mooney_rivlin"},
    {"no_direction", "normal: [0, 2, 0]", "normal: [0, 0, 0]",
     "scene.yaml:35: obstacles.ground.normal: must not be [0, 0, 0]: it is a direction"},
    {"point_and_offset", "point: [0, -1, 0]", "point: [0, -1, 0], offset: 1",
     "scene.yaml:35: obstacles.ground: 'point' and 'offset' exclude each other"},
    {"reversed_selection", "box: {min: [0, 0, 0]", "box: {min: [0, 2, 0]",
     "scene.yaml:39: constraints[1].box.min: must not exceed max, but does along y"},
    {"fixed_and_moved", "fixed: true", "fixed: true, velocity: [0, 0, 1]",
     "scene.yaml:38: constraints[0]: needs either 'fixed: true' or 'velocity'"},
    {"neither_fixed_nor_moved", ", fixed: true", "",
     "scene.yaml:38: constraints[0]: needs either 'fixed: true' or 'velocity'"},
    {"not_fixed", "fixed: true", "fixed: false",
     "scene.yaml:38: constraints[0].fixed: must be true where it is given; leave the constraint out to let "
     "the nodes go"},
    {"no_axis", "axes: [true, false, true]", "axes: [false, false, false]",
     "scene.yaml:39: constraints[1].axes: constrains nothing: one of the three must be true"},
    {"ends_before_it_begins", "until: 1", "until: 0.5",
     "scene.yaml:40: constraints[2]: 'until' must be later than 'from'"},
    {"keyframes_out_of_order", "[1, 0, 0.5, 0]", "[0, 0, 0.5, 0]",
     "scene.yaml:40: constraints[2].velocity[1]: has a time that is not later than that of the row before"},
    {"no_keyframes", "velocity: [0, 1, 0], axes", "velocity: [], axes",
     "scene.yaml:39: constraints[1].velocity: must be a list of 3 numbers, not of 0"},
    {"no_checkpoint_interval", "{every_simulated: 0.5, every_wall: 600}", "{}",
     "scene.yaml:44: checkpoint: needs 'every_simulated' [s], 'every_wall' [s] or both"},
    {"standing_time", "time_step: 1e-4", "time_step: 1e-300",
     "scene.yaml:43: integrator.time_step: '1e-300' is not allowed: it makes more than 1e9 of them until "
     "end_time"},
    {"endless_frames", "frames_per_second: 30", "frames_per_second: 1e300",
     "scene.yaml:6: output.frames_per_second: '1e300' is not allowed: it makes more than 1e9 of them until "
     "end_time"},
    {"endless_checkpoints", "every_simulated: 0.5", "every_simulated: 1e-20",
     "scene.yaml:44: checkpoint.every_simulated: '1e-20' is not allowed: it makes more than 1e9 of them "
     "until end_time"},
    // names
    {"constraint_on_nothing", "body: torus", "body: tours",
     "scene.yaml:40: constraints[2].body: there is no body 'tours': must be torus or box (did you mean "
     "'torus'?)"},
    {"dotted_name", "  box:\n", "  box.1:\n",
     "scene.yaml:29: bodies: the name 'box.1' is not allowed: must be 1 to 64 letters, digits, _ or -"},
    {"empty_scene_name", "name: full", "name: ''", "scene.yaml:1: name: must not be empty"},
    {"two_line_name", "name: full", "name: \"a\\nb\"",
     "scene.yaml:1: name: 'a\\nb' is not allowed: must be one line without control characters"},
    {"list_in_petsc", "damping_ksp_type: cg", "damping_ksp_type: [cg]",
     "scene.yaml:45: petsc.damping_ksp_type: must be a number or a word, not a list"},
    {"map_in_petsc", "damping_ksp_type: cg", "damping_ksp_type: {a: 1}",
     "scene.yaml:45: petsc.damping_ksp_type: must be a number or a word, not a map of keys"},
    {"option_of_the_process_in_petsc", "damping_ksp_type: cg", "log_view: null",
     "scene.yaml:45: petsc.log_view: must be given on the command line: PETSc reads it when there is no "
     "scene yet, or no more"},
    {"dash_in_petsc", "damping_ksp_type: cg", "-damping_ksp_type: cg",
     "scene.yaml:45: petsc.-damping_ksp_type: is written without its dash: damping_ksp_type"},
};

class InvalidScene : public ::testing::TestWithParam<Mistake> {};

TEST_P(InvalidScene, is_refused_in_one_sentence) {
  const auto& mistake = GetParam();
  ASSERT_EQ(testing::complaint(testing::full_scene), "nothing");
  const auto message =
      testing::complaint(testing::changed(testing::full_scene, mistake.right, mistake.wrong));
  EXPECT_EQ(message, mistake.message);
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0);
}

INSTANTIATE_TEST_SUITE_P(Scene, InvalidScene, ::testing::ValuesIn(mistakes),
                         [](const auto& test) { return test.param.name; });

TEST(InvalidScene, has_a_body) {
  EXPECT_EQ(testing::complaint("name: a\nend_time: 1\nbodies: {}\n"),
            "scene.yaml:3: bodies: must name at least one body");
}

TEST(InvalidScene, shows_long_values_short) {
  const auto message =
      testing::complaint("name: a\nend_time: " + std::string(100000, 'x') + "\nbodies: {}\n");
  EXPECT_LT(message.size(), 200U);
}

}  // namespace
}  // namespace evert
