#include "evert/scene/build.hpp"
#include "evert/scene/material.hpp"

#include <gtest/gtest.h>

#include "scenes.hpp"
#include <cmath>
#include <numbers>

namespace evert {
namespace {

using testing::changed;
using testing::full_scene;
using testing::least_scene;

SceneConfig full() { return parse_scene(full_scene, "folder/scene.yaml"); }
SceneConfig least() { return parse_scene(least_scene, "scene.yaml"); }

TEST(Load, reads_the_run) {
  const auto scene = full();
  EXPECT_EQ(scene.name, "full");
  EXPECT_EQ(scene.end_time, 2);
  EXPECT_EQ(scene.gravity, (Vec3d{{0, -9.81, 0}}));
  EXPECT_EQ(scene.output.directory, "runs/elsewhere");
  EXPECT_EQ(scene.output.frames_per_second, 30);
  EXPECT_EQ(scene.output.fields, (std::vector{OutputField::velocity, OutputField::rank}));
  EXPECT_EQ(scene.output.energy_log, 0);
  EXPECT_EQ(scene.integrator.time_step, 1e-4);
  EXPECT_EQ(scene.integrator.safety, 0.5);
  EXPECT_EQ(scene.integrator.max_strain_increment, 0.05);
  ASSERT_TRUE(scene.checkpoint);
  EXPECT_EQ(scene.checkpoint->every_simulated, 0.5);
  EXPECT_EQ(scene.checkpoint->every_wall, 600);
  const std::vector<std::pair<std::string, std::string>> petsc{{"damping_ksp_rtol", "1.0e-6"},
                                                               {"damping_ksp_type", "cg"}};
  EXPECT_EQ(scene.petsc, petsc);
}

TEST(Load, reads_bodies_in_order) {
  const auto scene = full();
  ASSERT_EQ(scene.bodies.size(), 2U);
  const auto& torus = scene.bodies[0];
  EXPECT_EQ(torus.name, "torus");
  const auto& mesh = std::get<FilledShape>(torus.mesh);
  EXPECT_EQ(std::get<TorusShape>(mesh.solid).major_radius, 0.5);
  EXPECT_EQ(std::get<TorusShape>(mesh.solid).minor_radius, 0.2);
  EXPECT_EQ(mesh.edge_length, 0.1);
  EXPECT_EQ(torus.transform.fit, 2);
  EXPECT_EQ(torus.transform.scale, 0.5);
  EXPECT_EQ(torus.transform.rotate->axis, (Vec3d{{0, 0, 1}}));
  EXPECT_EQ(torus.transform.rotate->angle, 90);
  EXPECT_EQ(torus.transform.translate, (Vec3d{{0, 1, 0}}));
  EXPECT_EQ(torus.density, 1000);
  EXPECT_EQ(torus.velocity, (Vec3d{{0, -1, 0}}));
  EXPECT_EQ(torus.spin, (Vec3d{{0.5, 0.25, 0}}));
  EXPECT_EQ(torus.start->kind, StartKind::scramble);
  EXPECT_EQ(torus.start->amplitude, 0.5);
  EXPECT_EQ(torus.start->axis, (Vec3d{{1, 0, 0}}));
  EXPECT_EQ(torus.start->seed, 7U);
  EXPECT_EQ(scene.bodies[1].name, "box");
}

TEST(Load, turns_damping_ratios_into_coefficients) {
  const auto properties = [](const std::string& damping) {
    const auto text = changed(full_scene, "{model: rotated, stiffness_proportional: 1.0e-3}", damping);
    return properties_of(parse_scene(text, "scene.yaml").bodies[0], -1);
  };
  // ξ = ω τ/2 + a/2ω with ω = 2π f
  const double pi = std::numbers::pi;
  const auto mixed = properties("{model: blended, stiffness_ratio: 0.06, mass_ratio: 0.04, frequency: 5}");
  EXPECT_EQ(mixed.damping.model, DampingModel::blended);
  const double time =
      mixed.damping.beta / lame_of(parse_scene(full_scene, "scene.yaml").bodies[0].material).mu;
  EXPECT_NEAR(2 * pi * 5 * time / 2, 0.06, 1e-15);
  EXPECT_NEAR(mixed.mass_proportional_damping.value() / (2 * 2 * pi * 5), 0.04, 1e-15);
  EXPECT_FALSE(properties("{model: blended, stiffness_proportional: 1}").mass_proportional_damping);
  const auto by_mass = properties("{model: none, mass_proportional: 3}");
  EXPECT_EQ(by_mass.damping.model, DampingModel::none);
  EXPECT_EQ(by_mass.mass_proportional_damping, 3);
}

TEST(Load, reads_materials_and_damping) {
  const auto scene = full();
  const auto& torus = scene.bodies[0];
  EXPECT_EQ(torus.material.model, MaterialModel::neo_hookean);
  EXPECT_EQ(torus.material.youngs_modulus, 1e5);
  EXPECT_EQ(torus.material.poissons_ratio, 0.45);
  EXPECT_EQ(torus.material.compression_limit, 0.3);
  EXPECT_EQ(torus.material.extension, Extension::clamp);
  EXPECT_EQ(torus.damping->model, DampingModel::rotated);
  EXPECT_EQ(torus.damping->stiffness_proportional, 1e-3);
  ASSERT_EQ(torus.groups.size(), 1U);
  const auto& tendon = torus.groups[0];
  EXPECT_EQ(tendon.name, "tendon");
  EXPECT_EQ(tendon.density, 1200);
  EXPECT_EQ(tendon.material->model, MaterialModel::st_venant_kirchhoff);
  EXPECT_EQ(tendon.material->poissons_ratio, -0.2);
  EXPECT_EQ(tendon.damping->model, DampingModel::none);
  const auto& box = scene.bodies[1];
  EXPECT_EQ(box.damping->model, DampingModel::objective);
  EXPECT_FALSE(box.damping->stiffness_proportional);
  EXPECT_EQ(box.damping->alpha, 3);
  EXPECT_EQ(box.damping->beta, 4);
}

TEST(Load, completes_a_box) {
  const auto by_corners = std::get<BoxMesh>(full().bodies[1].mesh);
  EXPECT_EQ(by_corners.size, (Vec3d{{1, 2, 3}}));
  EXPECT_EQ(by_corners.cells, (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ(by_corners.cell, BoxCells::tet5);
  EXPECT_EQ(by_corners.edge_length, 0);
  const auto text =
      testing::changed(least_scene, "generate: ball, radius: 1", "generate: box, size: [2, 4, 6]");
  const auto by_size = std::get<BoxMesh>(parse_scene(text, "scene.yaml").bodies[0].mesh);
  EXPECT_EQ(by_size.min, (Vec3d{{-1, -2, -3}}));
  EXPECT_EQ(by_size.max, (Vec3d{{1, 2, 3}}));
  EXPECT_EQ(by_size.cells, (std::array<int, 3>{0, 0, 0}));
}

TEST(Load, reads_obstacles_with_unit_normals) {
  const auto scene = full();
  ASSERT_EQ(scene.obstacles.size(), 2U);
  EXPECT_EQ(scene.obstacles[0].name, "ground");
  EXPECT_EQ(scene.obstacles[0].friction, 0.4);
  EXPECT_EQ(scene.obstacles[0].velocity, (Vec3d{{0, 0, 1}}));
  const auto& plane = std::get<HalfSpaceShape>(scene.obstacles[0].shape.solid);
  EXPECT_EQ(plane.normal, (Vec3d{{0, 1, 0}}));
  EXPECT_EQ(plane.offset, -1);
  const auto& sphere = std::get<SphereShape>(scene.obstacles[1].shape.solid);
  EXPECT_EQ(scene.obstacles[1].shape.center, (Vec3d{{1, 2, 3}}));
  EXPECT_EQ(sphere.radius, 4);
  EXPECT_EQ(scene.obstacles[1].friction, 0);
}

TEST(Load, finds_the_point_of_a_plane_from_its_offset) {
  const auto text = least_scene + "obstacles: {wall: {shape: half_space, normal: [0, 0, -5], offset: 2}}\n";
  const auto scene = parse_scene(text, "scene.yaml");
  EXPECT_EQ(std::get<HalfSpaceShape>(scene.obstacles[0].shape.solid).point, (Vec3d{{0, 0, -2}}));
}

TEST(Load, makes_unit_vectors_of_any_length) {
  for (const auto* vector : {"[3e200, 4e200, 0]", "[3e-200, 4e-200, 0]", "[3, 4, 0]"}) {
    const auto text = least_scene + "obstacles: {wall: {shape: half_space, normal: " + vector + "}}\n";
    const auto scene = parse_scene(text, "scene.yaml");
    const auto normal = std::get<HalfSpaceShape>(scene.obstacles[0].shape.solid).normal;
    EXPECT_NEAR(normal[0], 0.6, 1e-15) << vector;
    EXPECT_NEAR(normal[1], 0.8, 1e-15) << vector;
  }
}

TEST(Load, reads_constraints) {
  const auto scene = full();
  ASSERT_EQ(scene.constraints.size(), 3U);
  const auto& fixed = scene.constraints[0];
  EXPECT_EQ(fixed.body, 1U);
  EXPECT_EQ(std::get<NamedSelection>(fixed.nodes).node_set, "x_min");
  ASSERT_EQ(fixed.velocity.size(), 1U);
  EXPECT_EQ(fixed.velocity[0].velocity, Vec3d{});
  EXPECT_TRUE(std::isinf(fixed.until));
  const auto& moved = scene.constraints[1];
  EXPECT_EQ(std::get<BoxSelection>(moved.nodes).max, (Vec3d{{1, 1, 1}}));
  EXPECT_EQ(moved.velocity[0].velocity, (Vec3d{{0, 1, 0}}));
  EXPECT_EQ(moved.axes, (std::array{true, false, true}));
  const auto& timed = scene.constraints[2];
  EXPECT_EQ(timed.body, 0U);
  EXPECT_EQ(std::get<SphereSelection>(timed.nodes).radius, 0.1);
  ASSERT_EQ(timed.velocity.size(), 2U);
  EXPECT_EQ(timed.velocity[1].time, 1);
  EXPECT_EQ(timed.velocity[1].velocity, (Vec3d{{0, 0.5, 0}}));
  EXPECT_EQ(timed.from, 0.5);
  EXPECT_EQ(timed.until, 1);
}

TEST(Load, builds_nothing_that_is_not_named) {
  const auto scene = least();
  EXPECT_EQ(scene.gravity, Vec3d{});
  EXPECT_FALSE(scene.output.frames_per_second);
  EXPECT_FALSE(scene.output.energy_log);
  EXPECT_FALSE(scene.checkpoint);
  EXPECT_FALSE(scene.integrator.time_step);
  EXPECT_FALSE(scene.bodies[0].damping);
  EXPECT_FALSE(scene.bodies[0].start);
  EXPECT_FALSE(scene.bodies[0].transform.fit);
  EXPECT_TRUE(scene.obstacles.empty() && scene.constraints.empty() && scene.events.empty());
}

TEST(Load, takes_none_for_absent) {
  const auto text = least_scene + "    damping: {model: none, beta: 3}\n    start: {kind: none}\n";
  const auto scene = parse_scene(text, "scene.yaml");
  EXPECT_FALSE(scene.bodies[0].damping);
  EXPECT_FALSE(scene.bodies[0].start);
}

TEST(Load, reads_the_precision_of_a_body) {
  EXPECT_EQ(least().bodies[0].precision, Precision::full);
  const auto scene = parse_scene(least_scene + "    precision: mixed\n", "scene.yaml");
  EXPECT_EQ(scene.bodies[0].precision, Precision::mixed);
  EXPECT_EQ(properties_of(scene.bodies[0], -1).precision, Precision::mixed);
  EXPECT_EQ(testing::complaint(least_scene + "    precision: float\n"),
            "scene.yaml:8: bodies.ball.precision: 'float' is not allowed: must be double or mixed");
}

TEST(Load, names_the_output_after_the_scene) {
  EXPECT_EQ(least().output.directory, "runs/least");
  const auto odd = testing::changed(least_scene, "name: least", "name: '../a b/c'");
  EXPECT_EQ(parse_scene(odd, "scene.yaml").output.directory, "runs/___a_b_c");
}

TEST(Load, finds_mesh_files_beside_the_scene) {
  const auto text =
      testing::changed(least_scene, "generate: ball, radius: 1, edge_length: 0.5", "file: a.msh");
  const auto path = [&](const std::string& scene_file, const std::vector<std::string>& overrides = {}) {
    return std::get<FileMesh>(parse_scene(text, scene_file, overrides).bodies[0].mesh).path;
  };
  EXPECT_EQ(path("folder/scene.yaml"), "folder/a.msh");
  EXPECT_EQ(path("scene.yaml"), "a.msh");
  EXPECT_EQ(path("folder/scene.yaml", {"bodies.ball.mesh.file=/there/a.msh"}), "/there/a.msh");
  EXPECT_EQ(path("folder/scene.yaml", {"bodies.ball.mesh.file=a.msh"}), "a.msh");  // as typed in a shell
}

TEST(Load, keeps_a_canonical_text) {
  const auto reordered =
      testing::changed(least_scene, "generate: ball, radius: 1", "generate:   ball  , radius: 1");
  EXPECT_EQ(parse_scene(reordered, "other.yaml").text, least().text);
  EXPECT_NE(parse_scene(least_scene, "scene.yaml", std::vector<std::string>{"end_time=3"}).text,
            least().text);
}

TEST(Load, knows_what_a_restart_must_share) {
  const auto with = [](const std::string& override_text) {
    return parse_scene(full_scene, "scene.yaml", std::vector{override_text}).identity;
  };
  const auto same = full().identity;
  EXPECT_EQ(with("end_time=30"), same);
  EXPECT_EQ(with("output.frames_per_second=1"), same);
  EXPECT_EQ(with("integrator.safety=0.3"), same);
  EXPECT_EQ(with("checkpoint=null"), same);
  EXPECT_NE(with("gravity=[0, 0, 0]"), same);
  EXPECT_NE(with("bodies.torus.mesh.edge_length=0.11"), same);
  EXPECT_NE(with("obstacles.ground.friction=0"), same);
}

TEST(Load, reads_aliases) {
  const auto text = least_scene +
                    "    damping: &mine {model: rotated, beta: 3}\n"
                    "    groups: {a: {damping: *mine}}\n";
  EXPECT_EQ(parse_scene(text, "scene.yaml").bodies[0].groups[0].damping->beta, 3);
}

}  // namespace
}  // namespace evert
