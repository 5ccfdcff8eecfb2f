#include <gtest/gtest.h>

#include "scenes.hpp"

namespace evert {
namespace {

using testing::changed;
using testing::full_scene;

constexpr auto present_event = "  - {at: 0.5, set: bodies.torus.material.youngs_modulus, to: 2.0e5}\n";

SceneConfig with_events(const std::string& events) {
  return parse_scene(changed(full_scene, present_event, events), "scene.yaml");
}

std::string complaint(const std::string& event) {
  return testing::complaint(changed(full_scene, present_event, "  - " + event + "\n"));
}

TEST(Events, find_every_target) {
  const auto scene = with_events(
      "  - {at: 0, set: bodies.torus.material.youngs_modulus, to: 1}\n"
      "  - {at: 0, set: bodies.box.material.poissons_ratio, to: 0.2}\n"
      "  - {at: 0, set: bodies.torus.damping.stiffness_proportional, to: 3}\n"
      "  - {at: 0, set: bodies.box.damping.alpha, to: 4}\n"
      "  - {at: 0, set: bodies.box.damping.beta, to: 5}\n"
      "  - {at: 0, set: bodies.torus.groups.tendon.material.youngs_modulus, to: 6}\n"
      "  - {at: 0, set: gravity, to: [1, 2, 3]}\n"
      "  - {at: 0, set: obstacles.ball.friction, to: 8}\n");
  ASSERT_EQ(scene.events.size(), 8U);
  const auto& e = scene.events;
  EXPECT_EQ(e[0].target, EventTarget::material);
  EXPECT_EQ(e[0].owner, 0U);
  EXPECT_FALSE(e[0].group);
  EXPECT_EQ(e[1].target, EventTarget::material);
  EXPECT_EQ(e[2].target, EventTarget::damping);
  EXPECT_EQ(e[1].owner, 1U);
  EXPECT_EQ(e[1].value, 0.2);
  EXPECT_EQ(e[5].group, 0U);
  EXPECT_EQ(e[6].vector, (Vec3d{{1, 2, 3}}));
  EXPECT_EQ(e[7].owner, 1U);

  auto after = scene;
  for (const auto& event : scene.events) apply_event(after, event);
  EXPECT_EQ(after.bodies[0].material.youngs_modulus, 1);
  EXPECT_EQ(after.bodies[1].material.poissons_ratio, 0.2);
  EXPECT_EQ(after.bodies[0].damping->stiffness_proportional, 3);
  EXPECT_EQ(after.bodies[1].damping->alpha, 4);
  EXPECT_EQ(after.bodies[1].damping->beta, 5);
  EXPECT_EQ(after.bodies[0].groups[0].material->youngs_modulus, 6);
  EXPECT_EQ(after.gravity, (Vec3d{{1, 2, 3}}));
  EXPECT_EQ(after.obstacles[1].friction, 8);
  EXPECT_EQ(after.obstacles[0].friction, 0.4);
}

TEST(Events, change_damping_by_ratios_and_of_velocity) {
  const auto text = changed(changed(full_scene, "{model: rotated, stiffness_proportional: 1.0e-3}",
                                    "{model: blended, stiffness_ratio: 0.1, mass_ratio: 0.2, frequency: 3}"),
                            "{model: none}", "{model: none, mass_proportional: 4}");
  const auto scene =
      parse_scene(changed(text, present_event,
                          "  - {at: 0, set: bodies.torus.damping.stiffness_ratio, to: 0.5}\n"
                          "  - {at: 0, set: bodies.torus.damping.mass_ratio, to: 0.6}\n"
                          "  - {at: 0, set: bodies.torus.damping.frequency, to: 7}\n"
                          "  - {at: 0, set: bodies.torus.groups.tendon.damping.mass_proportional, to: 8}\n"),
                  "scene.yaml");
  auto after = scene;
  for (const auto& event : scene.events) apply_event(after, event);
  EXPECT_EQ(after.bodies[0].damping->stiffness_ratio, 0.5);
  EXPECT_EQ(after.bodies[0].damping->mass_ratio, 0.6);
  EXPECT_EQ(after.bodies[0].damping->frequency, 7);
  EXPECT_EQ(after.bodies[0].groups[0].damping->mass_proportional, 8);
}

TEST(Events, change_the_moduli_that_a_material_is_given_by) {
  const auto text = changed(full_scene, "youngs_modulus: 0, poissons_ratio: 0", "lambda: 1, mu: 2");
  const auto scene = parse_scene(changed(text, present_event,
                                         "  - {at: 0, set: bodies.box.material.lambda, to: 3}\n"
                                         "  - {at: 0, set: bodies.box.material.mu, to: 4}\n"),
                                 "scene.yaml");
  auto after = scene;
  for (const auto& event : scene.events) apply_event(after, event);
  EXPECT_EQ(after.bodies[1].material.lambda, 3);
  EXPECT_EQ(after.bodies[1].material.mu, 4);
}

/// Each must fit what those before it, in time, have left.
TEST(Events, are_checked_one_after_the_other) {
  const auto text = changed(full_scene, "youngs_modulus: 0, poissons_ratio: 0", "lambda: 1e5, mu: 1e5");
  const auto complaint_of = [&](const std::string& events) {
    return testing::complaint(changed(text, present_event, events));
  };
  const std::string softer = "  - {at: 1, set: bodies.box.material.mu, to: 1e3}\n";
  const std::string negative = "  - {at: 2, set: bodies.box.material.lambda, to: -1e4}\n";
  const std::string wrong = "'-1e4' is not allowed: must be > -2/3 mu";
  EXPECT_EQ(complaint_of(negative), "nothing");
  EXPECT_NE(complaint_of(softer + negative).find(wrong), std::string::npos)
      << complaint_of(softer + negative);
  EXPECT_NE(complaint_of(negative + softer).find(wrong), std::string::npos)
      << "whatever their order in the list";
}

TEST(Events, stand_in_order_of_time) {
  const auto scene = with_events(
      "  - {at: 2, set: obstacles.ball.friction, to: 1}\n"
      "  - {at: 1, set: obstacles.ball.friction, to: 2}\n"
      "  - {at: 1, set: obstacles.ball.friction, to: 3}\n");
  EXPECT_EQ(scene.events[0].value, 2);
  EXPECT_EQ(scene.events[1].value, 3);  // equal times: as written
  EXPECT_EQ(scene.events[2].value, 1);
}

TEST(Events, have_the_ranges_of_the_scene) {
  EXPECT_EQ(
      complaint("{at: 1, set: bodies.torus.material.poissons_ratio, to: 0.5}"),
      "scene.yaml:42: bodies.torus.material.poissons_ratio: '0.5' is not allowed: must be in (-1, 0.5)");
  EXPECT_EQ(complaint("{at: 1, set: gravity, to: 9.81}"),
            "scene.yaml:42: gravity: must be a list of 3 numbers, not '9.81'");
  EXPECT_EQ(complaint("{at: 1, set: obstacles.ground.friction, to: -1}"),
            "scene.yaml:42: obstacles.ground.friction: '-1' is not allowed: must be >= 0");
  EXPECT_EQ(complaint("{at: -1, set: gravity, to: [0, 0, 0]}"),
            "scene.yaml:42: events[0].at: '-1' is not allowed: must be >= 0");
}

TEST(Events, suggest_for_a_misspelt_target) {
  EXPECT_EQ(complaint("{at: 1, set: bodies.tors.material.youngs_modulus, to: 1}"),
            "scene.yaml:42: events[0].set: 'bodies.tors.material.youngs_modulus' is nothing that an event "
            "can set in this "
            "scene (did you mean 'bodies.torus.material.youngs_modulus'?); 'evert explain events.set' says "
            "what can be");
  // exists, but cannot change during a run
  EXPECT_TRUE(
      complaint("{at: 1, set: bodies.torus.density, to: 1}")
          .starts_with(
              "scene.yaml:42: events[0].set: 'bodies.torus.density' is nothing that an event can set"));
  // the torus has proportional damping
  EXPECT_NE(complaint("{at: 1, set: bodies.torus.damping.alpha, to: 1}"), "nothing");
}

}  // namespace
}  // namespace evert
