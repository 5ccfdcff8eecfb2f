#include <gtest/gtest.h>

#include "scenes.hpp"

namespace evert {
namespace {

using testing::full_scene;
using testing::least_scene;

SceneConfig with(const std::vector<std::string>& overrides, const std::string& text = full_scene) {
  return parse_scene(text, "scene.yaml", overrides);
}

std::string complaint(const std::string& text) { return testing::complaint(full_scene, {text}); }

TEST(Overrides, set_values_of_every_kind) {
  EXPECT_EQ(with({"end_time=7.5"}).end_time, 7.5);
  EXPECT_FALSE(with({"integrator.time_step=auto"}).integrator.time_step);
  EXPECT_EQ(with({"gravity=[1, 2, 3]"}).gravity, (Vec3d{{1, 2, 3}}));
  EXPECT_EQ(with({"gravity.1=-1"}).gravity, (Vec3d{{0, -1, 0}}));
  EXPECT_EQ(std::get<FilledShape>(with({"bodies.torus.mesh.edge_length=0.07"}).bodies[0].mesh).edge_length,
            0.07);
  EXPECT_EQ(with({"bodies.torus.groups.tendon.density=5"}).bodies[0].groups[0].density, 5);
  EXPECT_EQ(with({"constraints.2.until=9"}).constraints[2].until, 9);
  EXPECT_EQ(with({"constraints.2.sphere.radius=9"}).constraints[2].nodes.index(), 2U);
  EXPECT_EQ(with({"output.fields=[min_stretch]"}).output.fields, std::vector{OutputField::min_stretch});
  EXPECT_EQ(with({"petsc.damping_pc_type=none"}).petsc.back().second, "none");
}

TEST(Overrides, take_away_what_is_not_there) {
  EXPECT_TRUE(with({"petsc.damping_pc_type=null"}, least_scene).petsc.empty());
  EXPECT_FALSE(with({"checkpoint.every_wall=null"}, least_scene).checkpoint);
}

TEST(Overrides, apply_in_order) { EXPECT_EQ(with({"end_time=1", "end_time=2", "end_time=3"}).end_time, 3); }

TEST(Overrides, add_what_the_scene_leaves_out) {
  const auto scene = with({"checkpoint.every_wall=5", "bodies.ball.damping={model: rotated, beta: 2}",
                           "bodies.ball.start.kind=inside_out", "output.frames_per_second=24"},
                          least_scene);
  EXPECT_EQ(scene.checkpoint->every_wall, 5);
  EXPECT_EQ(scene.bodies[0].damping->beta, 2);
  EXPECT_EQ(scene.bodies[0].start->kind, StartKind::inside_out);
  EXPECT_EQ(scene.output.frames_per_second, 24);
}

TEST(Overrides, take_away_with_null) {
  EXPECT_FALSE(with({"checkpoint=null"}).checkpoint);
  EXPECT_FALSE(with({"bodies.torus.damping=null"}).bodies[0].damping);
  EXPECT_TRUE(with({"obstacles=null"}).obstacles.empty());
  EXPECT_EQ(with({"obstacles.ball=null"}).obstacles.size(), 1U);
}

TEST(Overrides, replace_the_keys_of_another_alternative) {
  const auto from_file = with({"bodies.torus.mesh.file=bunny.mesh"});
  EXPECT_EQ(std::get<FileMesh>(from_file.bodies[0].mesh).path, "bunny.mesh");
  const auto ball = with({"bodies.torus.mesh.generate=ball", "bodies.torus.mesh.radius=2"});
  EXPECT_EQ(std::get<FilledShape>(ball.bodies[0].mesh).edge_length, 0.1);  // goes with both
  const auto back =
      with({"bodies.torus.mesh.file=x.msh", "bodies.torus.mesh={generate: ball, radius: 2, edge_length: 1}"});
  EXPECT_EQ(std::get<SphereShape>(std::get<FilledShape>(back.bodies[0].mesh).solid).radius, 2);
  const auto sphere = with(
      {"obstacles.ground.shape=sphere", "obstacles.ground.center=[0, 0, 0]", "obstacles.ground.radius=1"});
  EXPECT_EQ(std::get<SphereShape>(sphere.obstacles[0].shape.solid).radius, 1);
  EXPECT_EQ(sphere.obstacles[0].friction, 0.4);
  const auto selection = with({"constraints.0.box={min: [0, 0, 0], max: [1, 1, 1]}"});
  EXPECT_TRUE(std::holds_alternative<BoxSelection>(selection.constraints[0].nodes));
}

TEST(Overrides, are_checked_like_the_scene) {
  EXPECT_EQ(complaint("bodies.torus.material.poissons_ratio=0.5"),
            "-set bodies.torus.material.poissons_ratio: '0.5' is not allowed: must be in (-1, 0.5)");
  EXPECT_EQ(complaint("end_time=soon"), "-set end_time: 'soon' is not allowed: must be a number");
  EXPECT_EQ(complaint("integrator.time_step=fast"),
            "-set integrator.time_step: 'fast' is not allowed: must be 'auto' or a number");
  EXPECT_EQ(complaint("bodies.torus=4"), "-set bodies.torus: must be a map of keys, not '4'");
  EXPECT_EQ(complaint("bodies=null"),
            "scene.yaml:1: 'bodies' is missing, e.g. bodies: {ball: {mesh: ..., density: "
            "1000, material: ...}}");
}

TEST(Overrides, suggest_for_a_misspelt_path) {
  EXPECT_EQ(complaint("integratr.time_step=1"),
            "-set integratr.time_step: 'integratr' is an unknown key (did you mean 'integrator'?)");
  EXPECT_EQ(complaint("integrator.timestep=1"),
            "-set integrator.timestep: 'timestep' is an unknown key (did you mean 'time_step'?)");
  EXPECT_EQ(complaint("bodies.torsu.density=1"),
            "-set bodies.torsu.density: 'torsu' is not in the scene (did you mean 'torus'?)");
  EXPECT_EQ(complaint("bodies.teapot.density=1"),
            "-set bodies.teapot.density: 'teapot' is not in the scene, which has torus or box");
  EXPECT_EQ(
      complaint("bodies.torus.mesh.edge_lenght=1"),
      "-set bodies.torus.mesh.edge_lenght: 'edge_lenght' is an unknown key (did you mean 'edge_length'?)");
}

TEST(Overrides, refuse_paths_that_lead_nowhere) {
  EXPECT_EQ(complaint("end_time"), "-set end_time: must be path=value, e.g. -set integrator.time_step=1e-4");
  EXPECT_EQ(complaint("=3"), "-set =3: must be path=value, e.g. -set integrator.time_step=1e-4");
  EXPECT_EQ(complaint("end_time.x=3"), "-set end_time.x: 'x' is no index: the scene has no list there");
  EXPECT_EQ(complaint("constraints.7.until=3"),
            "-set constraints.7.until: '7' is no index of the list, which has 3 items");
  EXPECT_EQ(complaint("constraints.first.until=3"),
            "-set constraints.first.until: 'first' is no index of the list, which has 3 items");
  EXPECT_EQ(complaint("gravity.1.2=3"), "-set gravity.1.2: '2' is one too many: the path ends before it");
  EXPECT_EQ(complaint("petsc.a.b=3"), "-set petsc.a.b: 'b' is one too many: the path ends before it");
  EXPECT_EQ(complaint("bodies.torus.mesh.generate.x=3"),
            "-set bodies.torus.mesh.generate.x: 'x' is one too many: the path ends before it");
  EXPECT_EQ(complaint("bodies..density=3"),
            "-set bodies..density: '' is not in the scene, which has torus or box");
  EXPECT_NE(complaint("name.=3"), "nothing");
  EXPECT_EQ(testing::complaint(least_scene, {"obstacles.ground.friction=0"}),
            "-set obstacles.ground.friction: 'ground' is not in the scene, which has none there");
}

TEST(Overrides, refuse_values_that_are_no_yaml) {
  EXPECT_TRUE(complaint("gravity=[1, 2").starts_with("-set gravity: not valid YAML: "));
  EXPECT_TRUE(complaint("name=\"a").starts_with("-set name: not valid YAML: "));
}

}  // namespace
}  // namespace evert
