#include "evert/scene/material.hpp"

#include <gtest/gtest.h>

#include "scenes.hpp"
#include <variant>

/// From the keys of a material to the model.
namespace evert {
namespace {

using testing::changed;
using testing::least_scene;

/// The model of the only body with this material; with fibres where it needs them.
Material material(const std::string& text) {
  const bool fibrous = text.find("muscle") != std::string::npos || text.find("tendon") != std::string::npos;
  const auto scene =
      parse_scene(changed(least_scene, "{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}",
                          text + (fibrous ? "\n    fibres: {direction: [1, 0, 0]}" : "")),
                  "scene.yaml", {});
  return material_of(scene.bodies[0].material);
}

TEST(SceneMaterial, TakesModuliInTwoWays) {
  const auto engineering =
      std::get<NeoHookean>(material("{model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.25}"));
  EXPECT_DOUBLE_EQ(engineering.lame.mu, 4e4);
  EXPECT_DOUBLE_EQ(engineering.lame.lambda, 4e4);
  const auto lame = std::get<StableNeoHookean>(material("{model: stable_neo_hookean, lambda: -1, mu: 3}"));
  EXPECT_EQ(lame.lame.lambda, -1);
  EXPECT_EQ(lame.lame.mu, 3);
}

TEST(SceneMaterial, TakesTheConstantsOfMooneyAndRivlin) {
  const auto muscle = std::get<MooneyRivlin>(
      material("{model: mooney_rivlin, mu_10: 6e4, mu_01: 2e4, bulk_modulus: 6e5, compression_limit: 0.25}"));
  EXPECT_DOUBLE_EQ(muscle.lame.mu, 1.6e5);
  EXPECT_DOUBLE_EQ(muscle.lame.bulk_modulus(), 6e5);
  EXPECT_DOUBLE_EQ(muscle.share_01, 0.25);
  EXPECT_EQ(muscle.compression_limit, 0.25);
  const auto rubber = std::get<MooneyRivlin>(material(
      "{model: mooney_rivlin, youngs_modulus: 1, poissons_ratio: 0.4, mu_01_share: 0.5, extension: clamp}"));
  EXPECT_EQ(rubber.share_01, 0.5);
  EXPECT_EQ(rubber.compression_limit, MooneyRivlin::default_compression_limit);
  EXPECT_EQ(rubber.extension, Extension::clamp);
}

TEST(SceneMaterial, TakesLimitsAndSlopesOfASpline) {
  const auto gears = std::get<Spline>(
      material("{model: spline, youngs_modulus: 5e4, poissons_ratio: 0.45, compression_limit: 0, "
               "elongation_limit: 2, compression_stiffening: 4, elongation_stiffening: 3}"));
  EXPECT_EQ(gears.compression_limit, 0);
  EXPECT_EQ(gears.elongation_limit, 2);
  EXPECT_EQ(gears.compression_stiffening, 4);
  EXPECT_EQ(gears.elongation_stiffening, 3);
}

TEST(SceneMaterial, HasTheDefaultsOfTheModel) {
  const std::string moduli = "youngs_modulus: 1, poissons_ratio: 0}";
  EXPECT_EQ(std::get<NeoHookean>(material("{model: neo_hookean, " + moduli)).compression_limit, 0.3);
  EXPECT_EQ(std::get<StVenantKirchhoff>(material("{model: st_venant_kirchhoff, " + moduli)).compression_limit,
            0.58);
  EXPECT_EQ(std::get<MooneyRivlin>(material("{model: mooney_rivlin, " + moduli)).compression_limit, 0.35);
  const auto spline = std::get<Spline>(material("{model: spline, " + moduli));
  EXPECT_EQ(spline.compression_limit, 0.5);
  EXPECT_EQ(spline.elongation_limit, 1.5);
  EXPECT_EQ(spline.compression_stiffening, 10);
  EXPECT_EQ(spline.elongation_stiffening, 10);
}

TEST(SceneMaterial, FibresHaveDefaultsAndKeysOfTheirOwn) {
  const std::string moduli = "mu_10: 6e4, mu_01: 2e4, bulk_modulus: 6e5";
  const auto plain = std::get<Muscle>(material("{model: muscle, " + moduli + "}"));
  EXPECT_DOUBLE_EQ(plain.lame.mu, 1.6e5);
  EXPECT_EQ(plain.share_01, 0.25);
  EXPECT_EQ(plain.compression_limit, 0.25);
  EXPECT_EQ(plain.peak_stress, 3e5);
  EXPECT_EQ(plain.passive.factor, 0.05);
  EXPECT_EQ(plain.passive.exponent, 6.6);
  EXPECT_EQ(plain.passive.linear_from, 1.4);
  EXPECT_EQ(plain.active.width, 0.6);
  EXPECT_EQ(plain.activation, 0);
  const std::string passive =
      ", compression_limit: 0.3, peak_stress: 1e6, passive_factor: 0.1, passive_exponent: 5, passive_limit: "
      "1.2";
  const auto other =
      std::get<Muscle>(material("{model: muscle, " + moduli + passive + ", active_width: 0.5}"));
  const auto tendon = std::get<Tendon>(material("{model: tendon, " + moduli + passive + "}"));
  EXPECT_EQ(other.active.width, 0.5);
  const auto expect_keys = [](const auto& model) {
    EXPECT_EQ(model.compression_limit, 0.3);
    EXPECT_EQ(model.peak_stress, 1e6);
    EXPECT_EQ(model.passive.factor, 0.1);
    EXPECT_EQ(model.passive.exponent, 5);
    EXPECT_EQ(model.passive.linear_from, 1.2);
  };
  expect_keys(other);
  expect_keys(tendon);
}

/// What the model is called in scenes is what it calls itself.
TEST(SceneMaterial, HasTheNameOfTheModel) {
  for (const auto& name : {"neo_hookean", "rotated_linear", "st_venant_kirchhoff", "mooney_rivlin", "spline",
                           "stable_neo_hookean", "muscle", "tendon"}) {
    const auto model = material("{model: " + std::string(name) + ", youngs_modulus: 1, poissons_ratio: 0}");
    EXPECT_EQ(std::visit([](const auto& one) { return one.name; }, model), name);
  }
}

/// Events set what the scene gives.
TEST(SceneMaterial, EventsSetYoungsModulusOnlyWhereItIsGiven) {
  const auto event = least_scene + "events: [{at: 0, set: bodies.ball.material.youngs_modulus, to: 2}]\n";
  EXPECT_EQ(testing::complaint(event), "nothing");
  const auto by_lame = changed(event, "youngs_modulus: 1e5, poissons_ratio: 0.3", "lambda: 1e5, mu: 1e5");
  EXPECT_NE(testing::complaint(by_lame).find("is nothing that an event can set"), std::string::npos);
}

}  // namespace
}  // namespace evert
