#include <gtest/gtest.h>

#include "case.hpp"
#include <algorithm>
#include <fstream>
#include <sstream>

/// Cases of `evert trade` and `evert tune`.
namespace evert::cli {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::size_t runs_in(const fs::path& directory) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(directory / "runs"))
    count += entry.path().extension() == ".h5" ? 1 : 0;
  return count;
}

/// 4 settings and two finer runs; the coarsest of the reference is one of the grid.
void expect_sweep(const fs::path& place) {
  const auto csv = content(place / "t/trade.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5) << csv;
  EXPECT_TRUE(content(place / "t/trade.svg").ends_with("</svg>\n"));
  EXPECT_NE(content(place / "t/front_1.yaml").find("time_step"), std::string::npos);
  EXPECT_EQ(runs_in(place / "t"), 6U);
}

/// A run is taken away, as if the sweep had been interrupted before it.
void forget_one_run(const fs::path& place) {
  fs::remove((*fs::directory_iterator(place / "t/runs")).path());
  fs::remove(place / "t/trade.csv");
}

void break_one_run(const fs::path& place) {
  const auto path = (*fs::directory_iterator(place / "t/runs")).path();
  fs::resize_file(path, fs::file_size(path) / 2);
}

const std::string sweep =
    "trade scene.yaml -vary integrator.time_step=5e-4,1e-3 -vary petsc.damping_ksp_rtol=1e-4,1e-8 -repeat 1 "
    "-out t";

/// The options must not reach into the scene's petsc block.
File steps_scene() { return scene({{"petsc: {damping_ksp_rtol: 1e-6}\n", ""}}); }

Case bad(const std::string& name, const std::string& command, const std::vector<std::string>& says,
         int exit_code = 2) {
  return {.name = name,
          .command = command,
          .files = {scene()},
          .exit_code = exit_code,
          .says = says,
          .ranks = {1, 2}};
}

const std::vector<Case> cases{
    {.name = "trade",
     .command = sweep,
     .files = {steps_scene()},
     .exit_code = 0,
     .says = {"vary integrator.time_step: 5e-4 1e-3", "reference: refinements by 2", "6 simulations made",
              "written to t: trade.csv"},
     .ranks = {1, 2},
     .inspect = expect_sweep},
    {.name = "trade_goes_on",
     .before = sweep,
     .spoil = forget_one_run,
     .command = sweep,
     .files = {steps_scene()},
     .exit_code = 0,
     .says = {"1 simulations made"},
     .ranks = {1, 2},
     .inspect = expect_sweep},
    {.name = "trade_makes_a_broken_run_again",
     .before = sweep,
     .spoil = break_one_run,
     .command = sweep,
     .files = {steps_scene()},
     .exit_code = 0,
     .says = {"1 simulations made"},
     .ranks = {1},
     .inspect = expect_sweep},
    {.name = "trade_front_runs",
     .before = sweep,
     .command = "run t/front_1.yaml",
     .files = {steps_scene()},
     .exit_code = 0,
     .says = {"test finished"},
     .ranks = {1}},
    {.name = "trade_times_again",
     .command = "trade scene.yaml -vary integrator.time_step=5e-4,1e-3 -repeat 3 -quiet -out t",
     .files = {scene()},
     .exit_code = 0,
     .says = {"8 simulations made"},
     .ranks = {1}},
    {.name = "trade_shows_what_explodes",
     .command = "trade scene.yaml -set end_time=2 -vary integrator.time_step=5e-3,0.4 -quiet -out t",
     .files = {scene()},
     .exit_code = 0,
     .says = {"time_step 0.4", "unstable"},
     .ranks = {1}},
    {.name = "trade_shows_what_cannot_be",
     .command =
         "trade scene.yaml -vary filter.time_step=1e-3 -vary integrator.time_step=5e-4,2e-3 -quiet -out t",
     .files = {scene()},
     .exit_code = 0,
     .says = {"time_step 2e-3", "refused: "},
     .ranks = {1, 2}},
    {.name = "trade_stops_what_is_slow",
     .command = "trade scene.yaml -vary integrator.time_step=1e-3 -limit 0 -out t",
     .files = {scene()},
     .exit_code = 3,
     .says = {"the reference is too slow", "stopped at t = "},
     .ranks = {1, 2}},
    {.name = "trade_of_everything_usual",
     .command = "trade scene.yaml -quiet -repeat 1",
     .files = {steps_scene()},
     .exit_code = 0,
     .says = {"vary integrator.safety: x0.25 x0.5 x1", "vary petsc.damping_ksp_rtol",
              "vary bodies.*.mesh.cells", "written to trade_test"},
     .ranks = {1}},
    {.name = "trade_of_elements",
     .command =
         "trade scene.yaml -vary bodies.*.mesh.element=tet4,hex8 -quiet -repeat 1 -probe top=0,0.5,0 -out t",
     .files = {scene()},
     .exit_code = 0,
     .says = {"element hex8"},
     .ranks = {1, 2}},
    {.name = "trade_of_states_of_rest",
     .command = "trade scene.yaml -vary bodies.cube.mesh.cells=[2,2,2],[1,1,1] -quiet -repeat 1 -out t",
     .files = {scene(
         {{"gravity: [0, -9.81, 0]\n",
           "gravity: [0, -9.81, 0]\nintegrator: {method: quasistatic}\n"
           "constraints: [{body: cube, node_set: y_min, fixed: true}]\n"},
          {"petsc: {damping_ksp_rtol: 1e-6}\n", ""},
          {"    damping: {model: rotated, stiffness_proportional: 0.01}\n", ""},
          {"obstacles:\n  ground: {shape: half_space, normal: [0, 1, 0], point: [0, -1, 0], friction: "
           "0.4}\n",
           ""}})},
     .exit_code = 0,
     .says = {"cells [1,1,1]"},
     .ranks = {1}},
    {.name = "trade_help",
     .command = "trade -help",
     .exit_code = 0,
     .says = {"-vary key=value,value", "trade.svg"}},
    {.name = "tune_help", .command = "tune --help", .exit_code = 0, .says = {"-budget 0.5"}},
    {.name = "tune",
     .command = "tune scene.yaml -error 50% -vary integrator.time_step=2.5e-4,5e-4,1e-3 -out t",
     .files = {scene()},
     .exit_code = 0,
     .says = {"within an error of 50 %", "settings of 3 run",
              "evert run scene.yaml -set integrator.time_step=", "t/tuned.yaml"},
     .ranks = {1, 2}},
    {.name = "tune_within_a_budget",
     .command = "tune scene.yaml -budget 1e6 -vary integrator.time_step=5e-4,1e-3 -out t",
     .files = {scene()},
     .exit_code = 0,
     .says = {"within a budget of 1e+06 CPU s per s", "time_step 5e-4"},
     .ranks = {1}},
    bad("tune_finds_nothing", "tune scene.yaml -error 1e-12 -vary integrator.time_step=5e-4,1e-3 -out t",
        {"no setting was found within an error", "the nearest is time_step 5e-4"}, 3),
    bad("tune_for_nothing", "tune scene.yaml", {"either -error", "-budget"}),
    bad("tune_for_both", "tune scene.yaml -error 1% -budget 1", {"either -error", "-budget"}),
    bad("tune_for_a_word", "tune scene.yaml -error small", {"-error", "not 'small'"}),
    bad("trade_no_scene", "trade", {"evert trade needs a scene file"}),
    bad("trade_missing_scene", "trade nowhere.yaml", {"nowhere.yaml", "no such file"}),
    bad("trade_bad_key", "trade scene.yaml -vary integrator.time_stp=1e-3", {"did you mean 'time_step'"}),
    bad("trade_no_values", "trade scene.yaml -vary integrator.time_step=", {"has an empty value"}),
    bad("trade_no_key", "trade scene.yaml -vary 1e-3", {"must be key=value,value"}),
    bad("trade_value_twice", "trade scene.yaml -vary integrator.time_step=1,1", {"a value twice"}),
    bad("trade_key_twice", "trade scene.yaml -vary gravity=[0,0,0] -vary gravity=[0,0,1]",
        {"is given twice"}),
    bad("trade_bad_value", "trade scene.yaml -vary integrator.time_step=-1",
        {"-vary integrator.time_step", "-1"}),
    bad("trade_unknown_element", "trade scene.yaml -vary bodies.*.mesh.element=hex9",
        {"there is no element 'hex9'", "did you mean 'hex8'"}),
    bad("trade_unknown_cell", "trade scene.yaml -vary bodies.*.mesh.cell=hex9",
        {"hex9", "did you mean 'hex8'"}),
    bad("trade_unknown_body", "trade scene.yaml -vary bodies.cub.density=1", {"did you mean 'cube'"}),
    bad("trade_too_many", "trade scene.yaml -vary gravity=[0,0,0] -vary", {"-vary needs a value"}),
    bad("trade_unknown_option", "trade scene.yaml -varry a=1", {"no option -varry", "did you mean '-vary'"}),
    bad("trade_unknown_petsc_option", "trade scene.yaml -vary petsc.damping_ksp_rtl=1e-3,1e-4",
        {"damping_ksp_rtl", "did you mean '-damping_ksp_rtol'"}),
    bad("trade_bad_probe", "trade scene.yaml -probe tip=0,0", {"-probe tip=0,0", "three numbers"}),
    bad("trade_probe_of_no_body", "trade scene.yaml -probe tip=cub:0,0,0", {"did you mean 'cube'"}),
    bad("trade_bad_repeat", "trade scene.yaml -repeat 0", {"-repeat", "at least 1"}),
    bad("trade_output_of_run", "trade scene.yaml -output here",
        {"-output is of evert run", "-out DIRECTORY"}),
    bad("trade_out_is_a_file", "trade scene.yaml -out scene.yaml", {"scene.yaml"}),
    bad("trade_bad_reference", "trade scene.yaml -vary integrator.time_step=1e-3 -reference integrator.tim=1",
        {"integrator.tim"}),
};

}  // namespace

std::vector<Case> trade_cases() { return cases; }

}  // namespace evert::cli
