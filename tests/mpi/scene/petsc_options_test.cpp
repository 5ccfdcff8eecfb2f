#include "evert/scene/petsc_options.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/petsc.hpp"

#include <gtest/gtest.h>

namespace evert {
namespace {

/// An empty database of options, that of the test's own command line restored at the end.
class PetscOptionsTest : public ::testing::Test {
 protected:
  void SetUp() override { check(PetscOptionsClear(nullptr)); }
  void TearDown() override { check(PetscOptionsClear(nullptr)); }

  static void command_line(const char* options) { check(PetscOptionsInsertString(nullptr, options)); }

  static std::string value(const char* option) {
    std::array<char, 64> text{};
    PetscBool set = PETSC_FALSE;
    check(PetscOptionsGetString(nullptr, nullptr, option, text.data(), text.size(), &set));
    return set == PETSC_TRUE ? text.data() : "absent";
  }

  static std::string message_of(const std::function<void()>& work) {
    try {
      work();
      return "nothing";
    } catch (const UserError& error) {
      return error.what();
    }
  }

  static std::string complaint(bool allow_unknown = false, bool damped = true) {
    return message_of([&] { reject_unused_options(PETSC_COMM_WORLD, allow_unknown, {.damping = damped}); });
  }

  static std::string missing(const SceneConfig& scene, const std::vector<std::string>& command_line) {
    return message_of([&] { require_option_values(scene, command_line); });
  }
};

TEST_F(PetscOptionsTest, come_from_the_scene) {
  SceneConfig scene;
  scene.petsc = {{"damping_ksp_rtol", "1e-3"}, {"damping_ksp_monitor", ""}};
  apply_petsc_block(scene);
  EXPECT_EQ(value("-damping_ksp_rtol"), "1e-3");
  EXPECT_EQ(value("-damping_ksp_monitor"), "");
}

TEST_F(PetscOptionsTest, of_the_command_line_win) {
  command_line("-damping_ksp_rtol 1e-9");
  SceneConfig scene;
  scene.petsc = {{"damping_ksp_rtol", "1e-3"}, {"damping_pc_type", "none"}};
  apply_petsc_block(scene);
  EXPECT_EQ(value("-damping_ksp_rtol"), "1e-9");
  EXPECT_EQ(value("-damping_pc_type"), "none");
}

TEST_F(PetscOptionsTest, that_nothing_reads_are_refused) {
  command_line("-damping_ksp_rtl 1e-9");
  EXPECT_EQ(complaint(),
            "-damping_ksp_rtl: unknown option (did you mean '-damping_ksp_rtol'?); -allow_unknown_options "
            "lets it pass");
  EXPECT_EQ(complaint(true), "nothing");
}

TEST_F(PetscOptionsTest, that_are_read_pass) {
  command_line("-damping_ksp_rtol 1e-9");
  EXPECT_EQ(value("-damping_ksp_rtol"), "1e-9");
  EXPECT_EQ(complaint(), "nothing");
}

TEST_F(PetscOptionsTest, from_the_scene_are_checked_too) {
  SceneConfig scene;
  scene.petsc = {{"zzz", "1"}};
  apply_petsc_block(scene);
  EXPECT_EQ(complaint(), "-zzz: unknown option; -allow_unknown_options lets it pass");
}

TEST_F(PetscOptionsTest, of_the_process_pass) {
  command_line("-options_left -citations");
  EXPECT_EQ(complaint(), "nothing");
}

TEST_F(PetscOptionsTest, of_solves_that_are_not_made_have_no_effect) {
  command_line("-damping_ksp_rtol 1e-9");
  EXPECT_EQ(complaint(false, false),
            "-damping_ksp_rtol: has no effect, since nothing in this scene is damped (bodies.NAME.damping) "
            "and masses "
            "are lumped (integrator.mass)");
  EXPECT_EQ(complaint(true, false), "nothing");
}

TEST_F(PetscOptionsTest, that_need_a_value_have_one) {
  SceneConfig scene;
  scene.petsc = {{"damping_ksp_monitor", ""}, {"damping_ksp_atol", "0"}};
  EXPECT_EQ(missing(scene, {"-damping_ksp_divtol", "-1", "-log_view"}), "nothing");
  EXPECT_EQ(missing(scene, {"-damping_ksp_rtol", "-log_view"}),
            "-damping_ksp_rtol: needs a value, but has none");
  EXPECT_EQ(missing(scene, {"-damping_pc_type"}), "-damping_pc_type: needs a value, but has none");
  scene.petsc.emplace_back("damping_ksp_rtol", "");
  EXPECT_EQ(missing(scene, {}), "petsc.damping_ksp_rtol: needs a value, but has none");
}

}  // namespace
}  // namespace evert
