#include <gtest/gtest.h>

#include "case.hpp"
#include <fstream>
#include <sstream>

/// Cases of `evert extremes`.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;

Case bad(const std::string& name, const std::string& arguments, const std::vector<std::string>& says) {
  return {.name = "extremes_" + name, .command = "extremes " + arguments, .says = says};
}

void expect_table(const fs::path& place) {
  std::ifstream file(place / "table.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const char* part : {"evert extremes", "## Step over the limit, by element", "| 10 x |", "detected, ",
                           "<!-- not made by evert extremes -->\nby hand"})
    EXPECT_NE(text.str().find(part), std::string::npos) << part;
  EXPECT_EQ(text.str().find("an old table"), std::string::npos);
}

const std::vector<Case> cases{
    {.name = "extremes_of_one_kind",
     .command = "extremes element/10_x/hex8 -out table.md",
     .files = {{"table.md", "an old table\n<!-- not made by evert extremes -->\nby hand\n"}},
     .exit_code = 0,
     .says = {"3 cases", "3 of 3 cases kept theirs",
              "3 of 3 caught (100.0 %), 3 before anything was not finite"},
     .inspect = expect_table},
    {.name = "extremes_quiet",
     .command = "extremes element/10_x/hex8_verlet -quiet",
     .exit_code = 0,
     .says = {"1 cases: 0 recovered, 0 stable, 1 failed with a message, 0 defects"}},
    {.name = "extremes_list",
     .command = "extremes scramble -list",
     .exit_code = 0,
     .says = {"scrambles_by_size/"}},
    // What hangs is not waited for.
    {.name = "extremes_time_limit",
     .command = "extremes rest/hex8/verlet -time_limit 1e-6",
     .exit_code = 1,
     .says = {"1 of 1 cases did not end as they must", "a_million_steps_at_rest/hex8/verlet",
              "does not end within the time limit"},
     .ranks = {1}},  // for one cell
    {.name = "extremes_scene",
     .command = "extremes starts_by_material/spline/scramble -write here",
     .exit_code = 0,
     .says = {"evert run here/scene.yaml"},
     .inspect = [](const fs::path& place) { EXPECT_TRUE(fs::exists(place / "here/scene.yaml")); }},
    {.name = "extremes_help", .command = "extremes --help", .exit_code = 0, .says = {"-time_limit S"}},
    bad("unknown", "nothing_of_this_name", {"there is no case with 'nothing_of_this_name' in its name"}),
    bad("unknown_option", "-lst", {"there is no option -lst", "did you mean '-list'?"}),
    bad("no_time", "-time_limit 0", {"-time_limit must be more than 0 s"}),
    bad("two_scenes", "spline/scramble -write here/and/there -time_limit x -list x",
        {"one argument too many"}),
    bad("many_scenes", "scramble -write here", {"-write needs the name of one case"}),
    bad("out_is_a_directory", "element/10_x/hex8_verlet -out .", {"."}),
};

}  // namespace

std::vector<Case> extremes_cases() { return cases; }

}  // namespace evert::cli
