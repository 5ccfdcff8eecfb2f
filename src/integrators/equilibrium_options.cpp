#include "equilibrium_options.hpp"

#include "evert/core/error.hpp"

#include "linear_solver_options.hpp"
#include <algorithm>
#include <vector>

namespace evert {
namespace {

const std::string prefix = "quasistatic_";
const std::vector<std::string> matrix_types{"aij", "baij", "sbaij"};
// Those of PETSc's that need nothing but forces, energy and stiffness.
const std::vector<std::string> methods{SNESNEWTONLS, SNESNEWTONTR, SNESQN};

void require_method(SNES snes) {
  const char* type = nullptr;
  check(SNESGetType(snes, &type));
  if (std::find(methods.begin(), methods.end(), type) == methods.end())
    throw UserError("-quasistatic_snes_type " + std::string(type) + " is not allowed: must be " +
                    list_of(methods));
}

void require_tolerances(SNES snes) {
  PetscReal atol = 0, rtol = 0, stol = 0;
  check(SNESGetTolerances(snes, &atol, &rtol, &stol, nullptr, nullptr));
  if (!(rtol >= 0 && rtol < 1)) throw UserError("-quasistatic_snes_rtol is not allowed: must be in [0, 1)");
  if (!(atol >= 0)) throw UserError("-quasistatic_snes_atol is not allowed: must be >= 0");
  if (!(stol >= 0 && stol < 1)) throw UserError("-quasistatic_snes_stol is not allowed: must be in [0, 1)");
}

}  // namespace

std::string quasistatic_matrix_type(MPI_Comm comm) {
  return matrix_type(comm, prefix, matrix_types, "aij, baij or sbaij");
}

SnesHandle quasistatic_snes(MPI_Comm comm, const std::string& matrix_type) {
  constexpr double rtol = 1e-9;
  constexpr double stol = 0;  // short steps of a hard line search are no sign of rest
  constexpr PetscInt most_iterations = 300, most_forces = 100000;
  constexpr PetscInt most_failed_linear_solves = 1000;  // what they found still descends
  SnesHandle snes;
  check(SNESCreate(comm, snes.out()));
  check(SNESSetOptionsPrefix(snes.get(), prefix.c_str()));
  check(SNESSetType(snes.get(), SNESNEWTONLS));
  check(SNESSetTolerances(snes.get(), PETSC_DEFAULT, rtol, stol, most_iterations, most_forces));
  check(SNESSetMaxLinearSolveFailures(snes.get(), most_failed_linear_solves));
  KSP ksp = nullptr;
  PC pc = nullptr;
  constexpr double linear_rtol = 1e-6;
  check(SNESGetKSP(snes.get(), &ksp));
  check(KSPSetType(ksp, KSPCG));
  check(KSPSetTolerances(ksp, linear_rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, matrix_type == "aij" ? PCGAMG : PCBJACOBI));
  return snes;
}

void read_quasistatic_options(SNES snes, const std::string& matrix_type) {
  check_options([&] { return SNESSetFromOptions(snes); });
  KSP ksp = nullptr;
  check(SNESGetKSP(snes, &ksp));
  require_method(snes);
  require_tolerances(snes);
  require_possible(ksp, prefix, matrix_type, matrix_types);
  rebuild_multigrid(ksp, prefix);
}

}  // namespace evert
