#include "evert/app/command_line.hpp"

#include "evert/core/error.hpp"

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

}  // namespace

RunArguments parse_run_arguments(std::span<const std::string> arguments) {
  RunArguments run;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto name = option_name(arguments[i]);
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= arguments.size())
        throw UserError("-" + name + " needs a value: evert run -help shows which");
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
      run.petsc.emplace_back("-help");
    } else if (!name.empty()) {
      // What follows one of PETSc's options is its value, unless it looks like the scene.
      run.petsc.push_back("-" + name);
      if (i + 1 < arguments.size() && option_name(arguments[i + 1]).empty() &&
          !ends_with_yaml(arguments[i + 1]))
        run.petsc.push_back(arguments[++i]);
    } else if (run.scene.empty()) {
      run.scene = arguments[i];
    } else {
      throw UserError("'" + arguments[i] + "' is one argument too many: evert run takes one scene, '" +
                      run.scene + "', and then options");
    }
  }
  if (run.scene.empty() && !run.help) throw UserError("evert run needs a scene file: evert run scene.yaml");
  return run;
}

std::string usage() {
  return R"(evert: simulates deformable solids that may flatten, invert and recover.

  evert run scene.yaml [-set key=value] [PETSc options]   simulate; mpirun -n 4 evert run ... in parallel
  evert check scene.yaml [-set key=value]                 validate without running: what would be built
  evert explain [key]                                     the scene reference
  evert mesh generate|convert|quality|partition           make and examine meshes
  evert view run.h5                                       a web page that plays the frames of a run
  evert bench kernels                                     how fast the kernels are on this machine
  evert run -help                                         every option of a run
  evert --version

Examples stand in examples/, the documentation in docs/.
)";
}

std::string run_usage() {
  return R"(evert run scene.yaml [options]

  -set key=value             override a value of the scene, e.g. -set integrator.time_step=1e-4; repeatable
  -restart file              go on from a checkpoint of the same scene, on any number of ranks
  -output directory          instead of the scene's output.directory
  -quiet                     no progress, errors only
  -allow_unknown_options     do not stop at PETSc options that nothing reads

Solvers, also as a 'petsc:' block of the scene (the command line wins):
  -damping_mat_type shell    operator of the damping solves: shell (matrix-free), baij, sbaij or aij
  -damping_ksp_type cg       any KSP for symmetric positive definite systems
  -damping_ksp_rtol 1e-8     relative to the change of momentum that the step asks for
  -damping_pc_type pbjacobi  shell: pbjacobi, jacobi, none; assembled: also gamg, hypre, icc, bjacobi, ...
  -damping_ksp_monitor, -damping_ksp_view, -log_view, -options_file, ...   as in any PETSc program

)";
}

}  // namespace evert
