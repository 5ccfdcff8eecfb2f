// The program: hands each subcommand its arguments, and turns what it throws into one line and an exit code.
#include "evert/app/bench_command.hpp"
#include "evert/app/check_command.hpp"
#include "evert/app/command_line.hpp"
#include "evert/app/explain_command.hpp"
#include "evert/app/extremes_command.hpp"
#include "evert/app/material_command.hpp"
#include "evert/app/mesh_command.hpp"
#include "evert/app/run_command.hpp"
#include "evert/app/stability_command.hpp"
#include "evert/app/trade_command.hpp"
#include "evert/app/view_command.hpp"
#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/log.hpp"
#include "evert/core/petsc.hpp"
#include "evert/core/version.hpp"

#include <petscsys.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace {

using Arguments = std::vector<std::string>;
using SerialCommand = std::function<int(const Arguments&)>;

enum ExitCode { done = 0, bug = 1, bad_input = 2, simulation_failed = 3 };

/// One line on stderr, from one rank.
void complain(const std::string& message) {
  if (evert::rank_of(MPI_COMM_WORLD) != 0) return;
  std::cout.flush();
  std::fprintf(stderr, "evert: %s\n", message.c_str());
}

/// Commands that need no other ranks run on rank 0; the others wait for its exit code.
int on_rank_zero(const SerialCommand& command, const Arguments& arguments) {
  int code = done;
  evert::on_root(MPI_COMM_WORLD, [&] { code = command(arguments); });
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return code;
}

int dispatch(const std::string& command, const Arguments& arguments) {
  const std::map<std::string, SerialCommand> serial{
      {"check", [](const Arguments& rest) { return evert::check_command(rest, std::cout); }},
      {"explain", [](const Arguments& rest) { return evert::explain_command(rest, std::cout); }},
      {"material", [](const Arguments& rest) { return evert::material_command(rest, std::cout); }},
      {"mesh", [](const Arguments& rest) { return evert::mesh_command(rest, std::cout); }},
      {"view", [](const Arguments& rest) { return evert::view_command(rest, std::cout); }},
  };
  if (command == "run") return evert::run_command(MPI_COMM_WORLD, evert::parse_run_arguments(arguments));
  if (command == "stability")
    return evert::stability_command(MPI_COMM_WORLD, evert::parse_stability_arguments(arguments), std::cout);
  if (command == "trade")
    return evert::trade_command(MPI_COMM_WORLD, evert::parse_trade_arguments(arguments, command), std::cout);
  if (command == "tune")
    return evert::tune_command(MPI_COMM_WORLD, evert::parse_trade_arguments(arguments, command), std::cout);
  if (command == "bench") return evert::bench_command(MPI_COMM_WORLD, arguments, std::cout);
  if (command == "extremes") return evert::extremes_command(MPI_COMM_WORLD, arguments, std::cout);
  if (const auto found = serial.find(command); found != serial.end())
    return on_rank_zero(found->second, arguments);
  std::vector<std::string> names{"run", "stability", "trade", "tune", "bench", "extremes"};
  for (const auto& [name, function] : serial) names.push_back(name);
  throw evert::UserError("there is no command '" + command + "': must be " + evert::list_of(names) +
                         evert::did_you_mean(command, names));
}

int guarded(const std::string& command, const Arguments& arguments) {
  try {
    return dispatch(command, arguments);
  } catch (const evert::UserError& error) {
    complain(error.what());
    return bad_input;
  } catch (const evert::SimulationError& error) {
    complain(std::string("the simulation failed: ") + error.what());
    return simulation_failed;
  } catch (const std::exception& error) {
    // Other ranks may be waiting inside a collective call: there is no way back.
    std::fprintf(stderr, "evert: bug: rank %d: %s\n", evert::rank_of(MPI_COMM_WORLD), error.what());
    MPI_Abort(MPI_COMM_WORLD, bug);
    return bug;
  }
}

/// PETSc sees its own options only; a command line that cannot be taken apart is left to the command to
/// complain about.
Arguments petsc_options(const std::string& command, const Arguments& arguments) {
  const bool runs_steps = command == "bench" && !arguments.empty() && arguments.front() == "step";
  const bool trades = command == "trade" || command == "tune";
  const bool only_looks = trades || command == "check" || command == "stability";
  if (command != "run" && !only_looks && !runs_steps) return {};
  try {
    // These describe themselves, without PETSc's pages.
    if (only_looks && evert::asks_for_help(arguments)) return {};
    if (command == "stability") return evert::parse_stability_arguments(arguments).run.petsc;
    if (trades) return evert::parse_trade_arguments(arguments, command).run.petsc;
    return evert::parse_run_arguments(std::span(arguments).subspan(runs_steps ? 1 : 0)).petsc;
  } catch (const evert::UserError&) {
    return {};
  }
}

/// One process that no launcher started needs neither a daemon beside it nor a look for fast networks, for
/// which Open MPI takes half a second. What the user has set stays.
void start_alone_without_delay() {
  for (const char* launched : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (std::getenv(launched) != nullptr) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

/// PETSc's sentence when it refuses to start (an options file that cannot be taken apart), else "".
std::string initialize_petsc(const char* program, Arguments options, const char* help) {
  std::vector<char*> argv{const_cast<char*>(program)};
  for (auto& option : options) argv.push_back(option.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(argv.size()) - 1;
  char** pointer = argv.data();
  start_alone_without_delay();
  return evert::refusal_of([&] { return PetscInitialize(&argc, &pointer, nullptr, help); });
}

/// Other ranks may be waiting for the one that PETSc failed on.
int refuse_to_start(const std::string& refusal) {
  std::fprintf(stderr, "evert: PETSc does not start: %s\n", refusal.c_str());
  int running = 0;
  MPI_Initialized(&running);
  if (running != 0) MPI_Abort(MPI_COMM_WORLD, bad_input);
  return bad_input;
}

/// The last thing of a run: PETSc writes what -log_view and its like ask for.
int finalize_petsc(int code) {
  const int rank = evert::rank_of(MPI_COMM_WORLD);  // nobody can be asked afterwards
  const auto refusal = evert::refusal_of([] { return PetscFinalize(); });
  if (refusal.empty()) return code;
  if (rank == 0) std::fprintf(stderr, "evert: PETSc does not end: %s\n", refusal.c_str());
  return bad_input;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments(argv + 1, argv + argc);
  const std::string command = arguments.empty() ? "--help" : arguments.front();
  if (command == "--help" || command == "-help" || command == "-h" || command == "help") {
    std::cout << evert::usage();
    return done;
  }
  if (command == "--version" || command == "-version") {
    std::cout << "evert " << evert::version() << '\n';
    return done;
  }
  arguments.erase(arguments.begin());
  evert::use_one_blas_thread();
  // Open MPI would keep shared file pointers, which nothing here uses, in /dev/shm, and could open no file
  // for a user who may not write there.
  setenv("OMPI_MCA_sharedfp", "^sm", 0);
  const auto help = evert::run_usage();
  const auto refusal = initialize_petsc(argv[0], petsc_options(command, arguments), help.c_str());
  if (!refusal.empty()) return refuse_to_start(refusal);
  std::signal(SIGPIPE, SIG_DFL);  // PETSc would report a crash after `evert explain | head`
  evert::register_log_events();
  const int code = guarded(command, arguments);
  std::cout.flush();
  return finalize_petsc(code);
}
