#pragma once
#include <span>
#include <string>
#include <vector>

namespace evert {

/// The arguments of `evert run`, taken apart: ours, and what goes to PETSc's options database.
struct RunArguments {
  std::string scene;                   ///< path of the scene file
  std::vector<std::string> overrides;  ///< of each -set path=value, in order
  std::string restart;                 ///< -restart file, or empty
  std::string output;                  ///< -output directory, or empty: as in the scene
  bool quiet = false;                  ///< -quiet
  bool allow_unknown_options = false;  ///< -allow_unknown_options
  bool help = false;                   ///< -help: what can be set, then stop
  std::vector<std::string> petsc;      ///< everything else, in order
};

/// Whether -h, -help or --help is among them.
[[nodiscard]] bool asks_for_help(std::span<const std::string> arguments);

/// Takes the arguments after `evert run`, or another `command` that takes the same, apart; options may be
/// written with one dash or two. Throws UserError when a value is missing, an options file cannot
/// be read, or there is not exactly one scene.
[[nodiscard]] RunArguments parse_run_arguments(std::span<const std::string> arguments,
                                               const std::string& command = "run");

/// The command of this run, as one can paste it into a shell.
[[nodiscard]] std::string run_line(const RunArguments& run);

/// The command that goes on from a checkpoint of this run, with everything that the run was given, as one can
/// paste it into a shell.
[[nodiscard]] std::string restart_command(const RunArguments& run, const std::string& checkpoint);

/// What `evert --help` prints.
[[nodiscard]] std::string usage();
/// What `evert check -help` prints.
[[nodiscard]] std::string check_usage();
/// What `evert run -help` prints before PETSc's own options.
[[nodiscard]] std::string run_usage();

}  // namespace evert
