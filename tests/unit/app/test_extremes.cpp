#include "evert/app/extreme_trial.hpp"
#include "evert/scene/load.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

/// The cases of `evert extremes`, and how what they end with is graded.
namespace evert {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ExtremeGrades, FollowFromTheEnd) {
  EXPECT_EQ(graded({}).grade, Grade::recovered);
  EXPECT_EQ(graded({.inverted_points = 1}).grade, Grade::stable);
  EXPECT_EQ(graded({.shape_error = 1e-5}).grade, Grade::stable);
  EXPECT_EQ(graded({.shape_error = 0.9 * recovered_within}).grade, Grade::recovered);
  EXPECT_EQ(graded({.shape_error = 0.1, .energy_gain = 0.9}).grade, Grade::defect);
  EXPECT_EQ(graded({.error = "at t = 0 s, step 0: something is wrong; try something else"}).grade,
            Grade::failed);
}

TEST(ExtremeGrades, NothingElsePasses) {
  EXPECT_EQ(graded({.timed_out = true}).grade, Grade::defect);
  EXPECT_EQ(graded({.finite = false}).grade, Grade::defect);
  EXPECT_EQ(graded({.shape_error = nan}).grade, Grade::stable) << "finite is what says so";
  EXPECT_EQ(graded({.shape_error = 0.1, .energy_gain = nan}).grade, Grade::defect);
  EXPECT_EQ(graded({.error = "bad"}).grade, Grade::defect) << "not clear";
  EXPECT_EQ(graded({.error = "the step of nan s is too long for what it does"}).grade, Grade::defect);
  EXPECT_FALSE(graded({.timed_out = true}).note.empty());
}

TEST(ExtremeGrades, FindTheStepThatAMessageRecommends) {
  EXPECT_EQ(suggested_step("blown up: try an integrator.time_step of 0.0125 or auto"), 0.0125);
  EXPECT_EQ(suggested_step("try an integrator.time_step of auto"), std::nullopt);
  EXPECT_EQ(suggested_step("blown up"), std::nullopt);
}

TEST(ExtremeCases, AreThreeHundredWithNamesOfTheirOwn) {
  const auto cases = extreme_cases(1);
  EXPECT_GE(cases.size(), 300U);
  std::set<std::string> names;
  for (const auto& one : cases) {
    EXPECT_TRUE(names.insert(one.name()).second) << one.name() << " is there twice";
    EXPECT_EQ(one.name().find_first_of(" ,"), std::string::npos) << one.name();
  }
}

/// All but combinations, of which some are refused.
TEST(ExtremeCases, AreScenes) {
  for (const auto& one : extreme_cases(2)) {
    if (one.family.starts_with("everything")) continue;
    EXPECT_NO_THROW(static_cast<void>(parse_scene(one.scene, "scene.yaml"))) << one.name() << '\n'
                                                                             << one.scene;
  }
}

TEST(ExtremeCases, PromiseWhatThePhysicsPromises) {
  const auto promised = [](const std::string& name) {
    for (const auto& one : extreme_cases(1))
      if (one.name() == name) return one.promise;
    return Promise::any;
  };
  for (const char* start : {"scramble", "flatten_plane", "flatten_line", "flatten_point", "inside_out"}) {
    EXPECT_EQ(promised(std::string("starts_by_material/neo_hookean/") + start), Promise::recovery);
    EXPECT_EQ(promised(std::string("starts_with_a_filter/compliant/") + start), Promise::recovery);
  }
  EXPECT_EQ(promised("scrambles_by_size/neo_hookean/1000_x"), Promise::recovery);
  EXPECT_EQ(promised("step_over_the_limit_by_material/neo_hookean/1.05_x"), Promise::any)
      << "row before column";
  EXPECT_EQ(promised("step_over_the_limit_by_material/1.05_x/neo_hookean"), Promise::detection);
}

}  // namespace
}  // namespace evert
