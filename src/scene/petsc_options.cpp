#include "evert/scene/petsc_options.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/petsc.hpp"

#include <petscsys.h>

#include <algorithm>
#include <vector>

namespace evert {
namespace {

/// Read by PETSc before there is a scene: of no effect in a `petsc:` block.
const std::vector<std::string> start_up_options{"help",        "info",         "log_view",    "malloc_debug",
                                                "memory_view", "options_file", "options_left"};

/// Options worth a suggestion: those of the solves we make, and the ones of PETSc that users type.
std::vector<std::string> well_known_options() {
  auto names = start_up_options;
  for (const auto* name : {"mat_type",
                           "ksp_type",
                           "ksp_rtol",
                           "ksp_atol",
                           "ksp_divtol",
                           "ksp_max_it",
                           "ksp_monitor",
                           "ksp_view",
                           "ksp_converged_reason",
                           "ksp_norm_type",
                           "ksp_initial_guess_nonzero",
                           "pc_type",
                           "pc_hypre_type",
                           "pc_gamg_type",
                           "pc_gamg_threshold",
                           "pc_factor_levels",
                           "pc_factor_mat_ordering_type",
                           "sub_pc_type",
                           "sub_ksp_type",
                           "mg_levels_ksp_type",
                           "mg_levels_pc_type"})
    names.push_back("damping_" + std::string(name));
  return names;
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

std::string complaint(const std::string& name, std::span<const std::string> known) {
  if (std::find(start_up_options.begin(), start_up_options.end(), name) != start_up_options.end())
    return "petsc." + name + ": must be given on the command line: PETSc reads it before there is a scene";
  const auto match = nearest_match(name, known);
  return "-" + name + ": unknown option" + (match.empty() ? "" : " (did you mean '-" + match + "'?)") +
         "; -allow_unknown_options lets it pass";
}

}  // namespace

void apply_petsc_block(const SceneConfig& scene) {
  for (const auto& [name, value] : scene.petsc) {
    const auto option = "-" + name;
    PetscBool given = PETSC_FALSE;
    check(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &given));
    if (given == PETSC_TRUE) continue;
    check(PetscOptionsSetValue(nullptr, option.c_str(), value.empty() ? nullptr : value.c_str()));
  }
}

void reject_unused_options(MPI_Comm comm, bool allow_unknown, std::span<const std::string> ours) {
  if (allow_unknown) return;
  std::string message;
  auto known = well_known_options();
  known.insert(known.end(), ours.begin(), ours.end());
  for (const auto& name : unused_options()) {
    if (std::find(ours.begin(), ours.end(), name) != ours.end()) continue;
    message = complaint(name, known);
    break;
  }
  agree_or_throw(comm, message);
}

}  // namespace evert
