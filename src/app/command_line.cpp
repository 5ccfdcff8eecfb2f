#include "evert/app/command_line.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace evert {
namespace {

/// "set" for -set and --set; "" for what is no option (negative numbers are values).
std::string option_name(const std::string& argument) {
  if (argument.size() < 2 || argument[0] != '-') return "";
  const auto start = argument[1] == '-' ? 2U : 1U;
  if (argument.size() == start || std::string("0123456789.").find(argument[start]) != std::string::npos)
    return "";
  return argument.substr(start);
}

bool ends_with_yaml(const std::string& argument) {
  return argument.ends_with(".yaml") || argument.ends_with(".yml");
}

/// As a POSIX shell reads it: in single quotes unless it is plain.
std::string quoted(const std::string& word) {
  constexpr std::string_view plain = "_-+=.,:/@%";
  const bool bare = std::all_of(word.begin(), word.end(), [&](unsigned char c) {
    return (c < 0x80 && std::isalnum(c) != 0) || plain.find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (bare && !word.empty()) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// PETSc reads the file on one rank, and lets the others wait when it cannot.
void require_readable(const std::string& options_file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(options_file, error) || !std::ifstream(options_file))
    throw UserError("-options_file " + options_file + ": there is no such file that can be read");
}

}  // namespace

bool asks_for_help(std::span<const std::string> arguments) {
  return std::ranges::any_of(arguments, [](const std::string& argument) {
    return argument == "-h" || argument == "-help" || argument == "--help";
  });
}

RunArguments parse_run_arguments(std::span<const std::string> arguments, const std::string& command) {
  RunArguments run;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto name = option_name(arguments[i]);
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= arguments.size())
        throw UserError("-" + name + " needs a value: evert " + command + " -help shows which");
      return arguments[++i];
    };
    if (name == "set") {
      run.overrides.push_back(value());
    } else if (name == "restart") {
      run.restart = value();
    } else if (name == "output") {
      run.output = value();
    } else if (name == "quiet") {
      run.quiet = true;
    } else if (name == "allow_unknown_options") {
      run.allow_unknown_options = true;
    } else if (name == "help" || name == "h") {
      run.help = true;
      // PETSc's handler of signals would report a crash where a pager is closed early.
      run.petsc.insert(run.petsc.end(), {"-help", "-no_signal_handler"});
    } else if (!name.empty()) {
      // What follows one of PETSc's options is its value, unless it looks like the scene.
      run.petsc.push_back("-" + name);
      if (i + 1 < arguments.size() && option_name(arguments[i + 1]).empty() &&
          !ends_with_yaml(arguments[i + 1]))
        run.petsc.push_back(arguments[++i]);
      if (name == "options_file") require_readable(run.petsc.back());
    } else if (run.scene.empty()) {
      run.scene = arguments[i];
    } else {
      throw UserError("'" + arguments[i] + "' is one argument too many: evert " + command +
                      " takes one scene, '" + run.scene + "', and then options");
    }
  }
  if (run.scene.empty() && !run.help)
    throw UserError("evert " + command + " needs a scene file: evert " + command + " scene.yaml");
  return run;
}

std::string restart_command(const RunArguments& run, const std::string& checkpoint) {
  auto again = run;
  again.restart = checkpoint;
  return run_line(again);
}

std::string run_line(const RunArguments& run) {
  std::vector<std::string> words{"evert", "run", run.scene};
  if (!run.restart.empty()) words.insert(words.end(), {"-restart", run.restart});
  for (const auto& override : run.overrides) words.insert(words.end(), {"-set", override});
  if (!run.output.empty()) words.insert(words.end(), {"-output", run.output});
  if (run.quiet) words.emplace_back("-quiet");
  if (run.allow_unknown_options) words.emplace_back("-allow_unknown_options");
  words.insert(words.end(), run.petsc.begin(), run.petsc.end());
  std::string line;
  for (const auto& word : words) line += (line.empty() ? "" : " ") + quoted(word);
  return line;
}

std::string usage() {
  return R"(evert: simulates deformable solids that may flatten, invert and recover

  evert run SCENE.yaml       simulate; on 4 ranks: mpirun -n 4 evert run SCENE.yaml
  evert check SCENE.yaml     say what would be built and what it would cost, and run nothing
  evert trade SCENE.yaml     measure what settings cost and how wrong they are, and which are worth it
  evert tune SCENE.yaml      find the cheapest setting within an error, or the best within a budget
  evert stability SCENE.yaml say how long a step may be, and which elements make it short
  evert view RUN.h5          make a web page that plays a run
  evert explain [KEY]        say what a key of a scene means, or list all
  evert mesh COMMAND ...     generate, convert, judge or partition a mesh
  evert material MODEL ...   print or draw the stress of a material, and check it against another code
  evert bench COMMAND ...    measure kernels and steps on this machine
  evert extremes [NAME]      run scenes as bad as they can be, and grade what comes out
  evert COMMAND --help       the options of a command
  evert --version

First steps:
  evert run examples/torus_puddle/scene.yaml
  evert view runs/torus_puddle/run.h5

Scenes to start from stand in examples/, the documentation in docs/.
)";
}

std::string check_usage() {
  return R"(evert check SCENE.yaml [options]: builds everything that a run would, and runs nothing

  -set key=value             override a value of the scene, as in evert run; repeatable
  -allow_unknown_options     do not stop at PETSc options that nothing reads
  Solver options are checked as evert run would read them: see evert run --help

Says what bodies, cells, obstacles and events there are, the time step, and what memory and time to expect: by
component, and for every feature that the scene names what it adds, measured by building the scene without it.
)";
}

std::string run_usage() {
  return R"(evert run SCENE.yaml [options]: simulates, and writes frames, energies and a summary

  -set key=value             override a value of the scene, e.g. -set integrator.time_step=1e-4; repeatable
  -output directory          instead of the scene's output.directory
  -restart file              go on from a checkpoint of the same scene, on any number of ranks
  -quiet                     no progress, errors only
  -allow_unknown_options     do not stop at PETSc options that nothing reads

Solvers, also as a 'petsc:' block of the scene (the command line wins):
  -damping_mat_type shell    operator of the damping solves: shell (matrix-free), baij, sbaij or aij
  -damping_ksp_type cg       any KSP for symmetric positive definite systems
  -damping_ksp_rtol 1e-8     relative to the change of momentum that the step asks for
  -damping_pc_type pbjacobi  shell: pbjacobi, jacobi, none; assembled: also gamg, hypre, icc, bjacobi, ...
  -quasistatic_mat_type aij  operator of the quasistatic solves: aij, baij or sbaij
  -quasistatic_snes_rtol 1e-9, -quasistatic_ksp_rtol 1e-6, -quasistatic_pc_type gamg, ...
  -damping_ksp_monitor, -damping_ksp_view, -log_view, -options_file, ...   as in any PETSc program

)";
}

}  // namespace evert
