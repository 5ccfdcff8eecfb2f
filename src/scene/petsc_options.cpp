#include "evert/scene/petsc_options.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/petsc.hpp"

#include <petscsys.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace evert {
namespace {

constexpr std::array<std::string_view, 4> solver_prefixes{"damping_", "projection_", "quasistatic_",
                                                          "stability_"};

/// Of the solves we make, without their prefix: options that mean nothing without a value.
const std::vector<std::string> valued_options{"mat_type",
                                              "ksp_type",
                                              "ksp_rtol",
                                              "ksp_atol",
                                              "ksp_divtol",
                                              "ksp_max_it",
                                              "ksp_norm_type",
                                              "pc_type",
                                              "pc_hypre_type",
                                              "pc_gamg_type",
                                              "pc_gamg_threshold",
                                              "pc_factor_levels",
                                              "pc_factor_mat_ordering_type",
                                              "sub_pc_type",
                                              "sub_ksp_type",
                                              "mg_levels_ksp_type",
                                              "mg_levels_pc_type",
                                              "snes_type",
                                              "snes_rtol",
                                              "snes_atol",
                                              "snes_stol",
                                              "snes_max_it",
                                              "snes_max_funcs",
                                              "snes_linesearch_type",
                                              "eps_type",
                                              "eps_tol",
                                              "eps_max_it",
                                              "eps_ncv"};
/// And those that may stand alone.
const std::vector<std::string> flag_options{"ksp_monitor",
                                            "ksp_view",
                                            "ksp_converged_reason",
                                            "ksp_initial_guess_nonzero",
                                            "snes_monitor",
                                            "snes_view",
                                            "snes_converged_reason",
                                            "snes_linesearch_monitor",
                                            "snes_ksp_ew",
                                            "eps_monitor",
                                            "eps_view",
                                            "eps_converged_reason"};
/// PETSc reads these in each solve, not in the set-up.
const std::vector<std::string> late_options{"ksp_converged_reason", "ksp_test_null_space",
                                            "snes_converged_reason", "snes_view"};

/// Eigenvalues are asked of `stability_` alone, nonlinear solves are `quasistatic_`.
bool goes_with(std::string_view prefix, std::string_view name) {
  if (prefix == "stability_" || name.starts_with("eps_"))
    return prefix == "stability_" && name.starts_with("eps_");
  return prefix == "quasistatic_" || !name.starts_with("snes_");
}

/// Options worth a suggestion: those of the solves we make, and the ones of PETSc that users type.
std::vector<std::string> well_known_options() {
  auto names = process_options();
  for (const auto prefix : solver_prefixes)
    for (const auto& list : {valued_options, flag_options})
      for (const auto& name : list)
        if (goes_with(prefix, name)) names.push_back(std::string(prefix) + name);
  return names;
}

bool contains(const std::vector<std::string>& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// -name, not a negative number.
bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

/// The prefix of ours that `name` begins with; empty when none.
std::string_view prefix_of(std::string_view name) {
  for (const auto prefix : solver_prefixes)
    if (name.starts_with(prefix)) return prefix;
  return {};
}

/// Throws when `name`, without dash, needs a value and has none.
void require_value(const std::string& name, bool has_value, const std::string& shown) {
  const auto prefix = prefix_of(name);
  if (has_value || prefix.empty()) return;
  if (contains(valued_options, name.substr(prefix.size())))
    throw UserError(shown + ": needs a value, but has none");
}

/// Of a solver that the simulation has.
bool is_live(std::string_view prefix, const LiveSolvers& live) {
  return prefix == "quasistatic_"  ? live.quasistatic
         : prefix == "projection_" ? live.projection
                                   : prefix == "damping_" && live.damping;
}

bool is_read_later(std::string_view name, const LiveSolvers& live) {
  const auto prefix = prefix_of(name);
  return is_live(prefix, live) && contains(late_options, name.substr(prefix.size()));
}

/// Options that were put into the database but never read, sorted so that every rank names the same one.
std::vector<std::string> unused_options() {
  PetscInt count = 0;
  char** names = nullptr;
  char** values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> unused(names, names + count);
  check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  std::sort(unused.begin(), unused.end());
  return unused;
}

std::string complaint(const std::string& name, const LiveSolvers& live) {
  const auto prefix = prefix_of(name);
  if (prefix == "damping_" && live.quasistatic)
    return "-" + name + ": has no effect, since integrator.method is quasistatic";
  if (prefix == "stability_" && !live.stability)
    return "-" + name + ": has no effect here: it is for evert stability";
  if (prefix == "damping_" && live.explicit_damping)
    return "-" + name +
           ": has no effect, since the integrator.method takes damping explicitly: that is for newmark";
  if (prefix == "damping_" && !is_live(prefix, live))
    return "-" + name +
           ": has no effect, since nothing in this scene is damped (bodies.NAME.damping) and masses are "
           "lumped (integrator.mass)";
  if (prefix == "quasistatic_" && !is_live(prefix, live))
    return "-" + name + ": has no effect, since integrator.method is not quasistatic";
  if (prefix == "projection_" && !is_live(prefix, live))
    return "-" + name + ": has no effect, since the scene has no filter with constraints: compliant or paper";
  const auto match = nearest_match(name, well_known_options());
  return "-" + name + ": unknown option" + (match.empty() ? "" : " (did you mean '-" + match + "'?)") +
         "; -allow_unknown_options lets it pass";
}

}  // namespace

const std::vector<std::string>& process_options() {
  static const std::vector<std::string> names{
      "citations",    "fp_trap",     "help",         "history",      "info",         "log_exclude",
      "log_trace",    "log_view",    "malloc",       "malloc_debug", "malloc_dump",  "malloc_test",
      "malloc_view",  "memory_view", "objects_dump", "options_file", "options_left", "options_monitor",
      "options_view", "version"};
  return names;
}

LiveSolvers solvers_of(const Simulation& simulation) {
  const bool solves = simulation.solves_for_velocities();
  return {.damping = solves,
          .explicit_damping = !solves && !simulation.quasistatic() && simulation.elastic().damped(),
          .quasistatic = simulation.quasistatic(),
          .projection = simulation.implicit_strains() != nullptr || simulation.projection() != nullptr};
}

void apply_petsc_block(const SceneConfig& scene) {
  for (const auto& [name, value] : scene.petsc) {
    const auto option = "-" + name;
    PetscBool given = PETSC_FALSE;
    check(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &given));
    if (given == PETSC_TRUE) continue;
    check(PetscOptionsSetValue(nullptr, option.c_str(), value.empty() ? nullptr : value.c_str()));
  }
}

void require_option_values(const SceneConfig& scene, std::span<const std::string> command_line) {
  for (const auto& [name, value] : scene.petsc) require_value(name, !value.empty(), "petsc." + name);
  for (std::size_t i = 0; i < command_line.size(); ++i) {
    const bool has_value = i + 1 < command_line.size() && !is_option(command_line[i + 1]);
    if (is_option(command_line[i])) require_value(command_line[i].substr(1), has_value, command_line[i]);
  }
}

void reject_unused_options(MPI_Comm comm, bool allow_unknown, const LiveSolvers& live) {
  if (allow_unknown) return;
  std::string message;
  for (const auto& name : unused_options())
    if (message.empty() && !contains(process_options(), name) && !is_read_later(name, live))
      message = complaint(name, live);
  agree_or_throw(comm, message);
}

}  // namespace evert
