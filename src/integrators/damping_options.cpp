#include "damping_options.hpp"

#include "linear_solver_options.hpp"
#include <vector>

namespace evert {
namespace {

const std::string prefix = "damping_";
const std::vector<std::string> matrix_types{"shell", "baij", "sbaij", "aij"};

/// PETSc's default for CG is the norm of the preconditioned residual, which takes one more sum over the ranks
/// in each iteration than the natural norm.
void prefer_natural_norm(KSP ksp) {
  PetscBool cg = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPCG, &cg));
  PetscBool told = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, prefix.c_str(), "-ksp_norm_type", &told));
  if (cg == PETSC_TRUE && told == PETSC_FALSE) check(KSPSetNormType(ksp, KSP_NORM_NATURAL));
}

}  // namespace

std::string damping_matrix_type(MPI_Comm comm) {
  return matrix_type(comm, prefix, matrix_types, "shell (matrix-free), baij, sbaij or aij");
}

KspHandle damping_ksp(MPI_Comm comm, const std::string& matrix_type) {
  KspHandle ksp;
  check(KSPCreate(comm, ksp.out()));
  check(KSPSetOptionsPrefix(ksp.get(), prefix.c_str()));
  check(KSPSetType(ksp.get(), KSPCG));
  PC pc = nullptr;
  check(KSPGetPC(ksp.get(), &pc));
  check(PCSetType(pc, matrix_type == "sbaij" ? PCJACOBI : PCPBJACOBI));
  constexpr double default_rtol = 1e-8;  // what momentum is balanced to
  check(KSPSetTolerances(ksp.get(), default_rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  check_options([&] { return KSPSetFromOptions(ksp.get()); });
  require_possible(ksp.get(), prefix, matrix_type, matrix_types);
  prefer_natural_norm(ksp.get());
  rebuild_multigrid(ksp.get(), prefix);
  return ksp;
}

void try_damping_set_up(Mat mat, const std::string& matrix_type) {
  const auto ksp = damping_ksp(PetscObjectComm(reinterpret_cast<PetscObject>(mat)), matrix_type);
  check(KSPSetOperators(ksp.get(), mat, mat));
  try_set_up(ksp.get());
}

}  // namespace evert
