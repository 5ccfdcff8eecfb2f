#include "evert/core/error.hpp"
#include "evert/trade/variation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evert::trade {
namespace {

const char* const two_bodies = R"(
name: two
end_time: 1
bodies:
  ball:
    mesh: {generate: ball, radius: 0.5, edge_length: 0.2}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
  block:
    mesh: {generate: box, size: [1, 1, 1], cells: [4, 2, 2], cell: hex8}
    transform: {translate: [3, 0, 0]}
    density: 1000
    material: {model: neo_hookean, youngs_modulus: 1e5, poissons_ratio: 0.3}
integrator: {time_step: 2e-3}
)";

SceneSource source() { return {two_bodies, "two.yaml"}; }

Axis axis_of(const std::string& text, const Automatic& automatic = {}) {
  return resolve(source(), parse_variation(text), automatic);
}

std::string refusal_of(const std::string& text) {
  try {
    static_cast<void>(axis_of(text));
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(Variation, ValuesAreSplitAtCommasOutsideOfBrackets) {
  const auto variation = parse_variation("bodies.block.mesh.cells=[4, 2, 2],[8,4,4]");
  EXPECT_EQ(variation.key, "bodies.block.mesh.cells");
  ASSERT_EQ(variation.values.size(), 2U);
  EXPECT_EQ(variation.values[0], "[4, 2, 2]");
  EXPECT_EQ(variation.values[1], "[8,4,4]");
}

TEST(Variation, WhatIsNoneIsRefused) {
  for (const auto* text : {"integrator.time_step", "=1", "integrator.time_step=", "a=1,,2", "a=1,1"})
    EXPECT_THROW(static_cast<void>(parse_variation(text)), UserError) << text;
}

TEST(Variation, MultiplesAreOfWhatTheSceneHas) {
  const auto axis = axis_of("integrator.time_step=x0.5,x2");
  EXPECT_EQ(axis.overrides[0], Overrides{"integrator.time_step=0.001"});
  EXPECT_EQ(axis.overrides[1], Overrides{"integrator.time_step=0.004"});
  EXPECT_EQ(axis.best, 0U);
  EXPECT_TRUE(axis.is_coarser(1, 0));
  const auto counts = axis_of("bodies.block.mesh.cells=x1,x2");
  EXPECT_EQ(counts.overrides[1], Overrides{"bodies.block.mesh.cells=[8, 4, 4]"});
  EXPECT_EQ(counts.best, 1U);
}

TEST(Variation, MultiplesOfAutoAreOfWhatAutoIs) {
  EXPECT_EQ(axis_of("filter.time_step=x2", {{"filter.time_step", 1e-3}}).overrides[0],
            Overrides{"filter.time_step=0.002"});
  EXPECT_NE(refusal_of("bodies.ball.damping.stiffness_proportional=x2").find("nothing there"),
            std::string::npos);
}

TEST(Variation, StarStandsForBodiesThatHaveTheKey) {
  EXPECT_EQ(axis_of("bodies.*.mesh.edge_length=x1").overrides[0],
            Overrides{"bodies.ball.mesh.edge_length=0.2"});
  const auto both = axis_of("bodies.*.mesh.edge_length=0.3");
  EXPECT_EQ(both.overrides[0], (Overrides{"bodies.ball.mesh.edge_length=0.3", "bodies.block.mesh.cells=null",
                                          "bodies.block.mesh.edge_length=0.3"}));
  EXPECT_NE(refusal_of("constraints.*.fixed=true").find("nothing that * could stand for"), std::string::npos);
}

TEST(Variation, ElementsAreWhatEachMeshCanHave) {
  const auto axis = axis_of("bodies.*.mesh.element=tet4,tet10");
  EXPECT_EQ(axis.overrides[0],
            (Overrides{"bodies.ball.order=1", "bodies.block.mesh.cell=tet6", "bodies.block.order=1"}));
  EXPECT_EQ(axis.best, 1U);
  EXPECT_NE(refusal_of("bodies.*.mesh.element=tet11").find("did you mean 'tet10'"), std::string::npos);
}

TEST(Variation, WrongKeysAndValuesNameTheNearest) {
  EXPECT_NE(refusal_of("integrator.time_stp=1").find("did you mean 'time_step'"), std::string::npos);
  EXPECT_TRUE(refusal_of("integrator.time_step=-1").starts_with("-vary integrator.time_step"));
}

TEST(Variation, TheGridHasAllCombinations) {
  const std::vector<Axis> axes{axis_of("integrator.time_step=1e-3,2e-3"),
                               axis_of("integrator.method=newmark,verlet,symplectic_euler")};
  const auto grid = grid_of(axes);
  ASSERT_EQ(grid.size(), 6U);
  EXPECT_EQ(grid[1], (Choice{0, 1}));
  EXPECT_EQ(overrides_of(axes, grid[5]),
            (Overrides{"integrator.time_step=2e-3", "integrator.method=symplectic_euler"}));
  EXPECT_EQ(label_of(axes, grid[0]), "time_step 1e-3, method newmark");
}

TEST(Variation, TheReferenceIsFinerInAllThatCanBeFiner) {
  const std::vector<Axis> axes{
      axis_of("integrator.time_step=x2,1e-3"), axis_of("bodies.block.mesh.cells=[4,2,2]"),
      axis_of("petsc.damping_ksp_rtol=1e-2,1e-4"), axis_of("integrator.method=verlet")};
  EXPECT_EQ(reference_of(source(), axes, {}, 0, 2, {}),
            (Overrides{"integrator.time_step=1e-3", "bodies.block.mesh.cells=[4,2,2]",
                       "petsc.damping_ksp_rtol=1e-4", "integrator.method=verlet"}));
  EXPECT_EQ(reference_of(source(), axes, {}, 2, 2, {"end_time=2"}),
            (Overrides{"integrator.time_step=0.00025", "bodies.block.mesh.cells=[16,8,8]",
                       "petsc.damping_ksp_rtol=1e-06", "integrator.method=verlet", "end_time=2"}));
  EXPECT_EQ(refinement_ratio(axes), 2);
  EXPECT_EQ(refinement_ratio(std::vector<Axis>{axis_of("bodies.ball.mesh.edge_length=0.1")}), std::sqrt(2.0));
}

TEST(SceneSource, WritesASceneThatMeansTheSame) {
  const auto scene = source();
  const Overrides overrides{"bodies.block.mesh.cells=[8, 4, 4]"};
  const auto yaml = scene.yaml(overrides, "elsewhere");
  EXPECT_EQ(SceneSource(yaml, "elsewhere/again.yaml").variant().text, scene.variant(overrides).text) << yaml;
}

TEST(SceneSource, FilesAreFoundFromTheNewFolder) {
  const SceneSource scene(
      "name: f\nend_time: 1\nbodies: {b: {mesh: {file: m.msh}, density: 1, material: {model: neo_hookean, "
      "youngs_modulus: 1, poissons_ratio: 0.3}}}\n",
      "scenes/f.yaml");
  const auto yaml = scene.yaml({}, "out");
  EXPECT_NE(yaml.find("\"../scenes/m.msh\""), std::string::npos) << yaml;
}

}  // namespace
}  // namespace evert::trade
