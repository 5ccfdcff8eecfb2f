#include "damping_options.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace evert {
namespace {

const std::vector<std::string> matrix_types{"shell", "baij", "sbaij", "aij"};

/// A preconditioner, the matrix types that PETSc 3.18 has it for, and whether it works on several ranks.
struct Preconditioner {
  std::string name;
  std::vector<std::string> matrices;
  bool parallel = true;
};

/// Those that are known to work or to fail. Others of PETSc's need options of their own (composite,
/// fieldsplit, ...): with an assembled matrix they are tried.
const std::vector<Preconditioner>& preconditioners() {
  static const std::vector<Preconditioner> known{
      {"none", matrix_types},
      {"jacobi", matrix_types},
      {"mat", matrix_types},
      {"pbjacobi", {"shell", "baij", "aij"}},
      {"bjacobi", {"baij", "sbaij", "aij"}},
      {"asm", {"baij", "sbaij", "aij"}},
      {"gasm", {"aij"}},
      {"sor", {"baij", "aij"}},
      {"eisenstat", {"aij"}},
      {"ilu", {"baij", "aij"}, false},
      {"icc", {"baij", "sbaij", "aij"}, false},
      {"lu", {"baij", "aij"}},
      {"cholesky", {"sbaij", "aij"}},
      {"gamg", {"aij"}},
      {"ml", {"aij"}},
      {"hypre", {"baij", "sbaij", "aij"}},
  };
  return known;
}

bool holds(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// In PETSc's own style, so that -help lists the option.
PetscErrorCode read_matrix_type(MPI_Comm comm, char* text, std::size_t size) {
  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, "damping_", "Operator of the damping solves", nullptr);
  PetscCall(PetscOptionsString("-mat_type", "shell (matrix-free), baij, sbaij or aij", nullptr, text, text,
                               size, nullptr));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

std::string type_of(PC pc) {
  const char* type = nullptr;
  check(PCGetType(pc, &type));
  return type == nullptr ? "none" : type;
}

/// PETSc finds out in the middle of its set-up, on some ranks before others: decided here beforehand.
void require_possible(const std::string& name, const std::string& matrix, int ranks) {
  const auto& known = preconditioners();
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name; });
  const auto option = "-damping_pc_type " + name;
  if (name == "shell") {
    std::vector<std::string> names;
    for (const auto& one : known) names.push_back(one.name);
    throw UserError(option + " is not allowed, since evert has none of its own: must be " + list_of(names));
  }
  const std::vector<std::string> assembled(matrix_types.begin() + 1, matrix_types.end());
  const auto& allowed = found == known.end() ? assembled : found->matrices;
  if (matrix == "shell" && !holds(allowed, matrix))
    throw UserError(option + " needs the entries of the matrix: add -damping_mat_type " + list_of(allowed));
  if (!holds(allowed, matrix))
    throw UserError(option + " does not work with -damping_mat_type " + matrix + ": must be " +
                    list_of(allowed));
  if (found != known.end() && !found->parallel && ranks > 1)
    throw UserError(option +
                    " works on one rank only: on several, -damping_pc_type bjacobi -damping_sub_pc_type " +
                    name + " does the same on each");
}

/// What PETSc takes without a word, and then ends every solve at its first guess or never.
void require_tolerances(KSP ksp) {
  PetscReal rtol = 0;
  PetscReal atol = 0;
  check(KSPGetTolerances(ksp, &rtol, &atol, nullptr, nullptr));
  if (!(rtol >= 0 && rtol < 1)) throw UserError("-damping_ksp_rtol is not allowed: must be in [0, 1)");
  if (!(atol >= 0)) throw UserError("-damping_ksp_atol is not allowed: must be >= 0");
}

/// Without iterations, the preconditioner must be a solver.
void require_solver(KSP ksp, const std::string& preconditioner) {
  const std::vector<std::string> direct{"lu", "cholesky", "qr", "svd", "redundant", "ksp"};
  const char* type = nullptr;
  check(KSPGetType(ksp, &type));
  if (std::string(type) == KSPPREONLY && !holds(direct, preconditioner))
    throw UserError("-damping_ksp_type preonly solves nothing with -damping_pc_type " + preconditioner +
                    ": must be with " + list_of(direct));
}

/// PETSc's default for CG is the norm of the preconditioned residual, which takes one more sum over the ranks
/// in each iteration than the natural norm.
void prefer_natural_norm(KSP ksp) {
  PetscBool cg = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPCG, &cg));
  PetscBool told = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, "damping_", "-ksp_norm_type", &told));
  if (cg == PETSC_TRUE && told == PETSC_FALSE) check(KSPSetNormType(ksp, KSP_NORM_NATURAL));
}

/// GAMG keeps its first coarse spaces and eigenvalues unless told otherwise; ours change by orders of
/// magnitude with the step and the material.
void rebuild_multigrid(PC pc) {
  PetscBool told = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, "damping_", "-pc_gamg_reuse_interpolation", &told));
  if (told == PETSC_FALSE) check(PCGAMGSetReuseInterpolation(pc, PETSC_FALSE));
}

}  // namespace

std::string damping_matrix_type(MPI_Comm comm) {
  std::array<char, 64> text{"shell"};
  check(read_matrix_type(comm, text.data(), text.size()));
  const std::string type = text.data();
  if (!holds(matrix_types, type))
    throw UserError("-damping_mat_type " + type + " is not allowed: must be " + list_of(matrix_types) +
                    did_you_mean(type, matrix_types));
  return type;
}

KspHandle damping_ksp(MPI_Comm comm, const std::string& matrix_type) {
  KspHandle ksp;
  check(KSPCreate(comm, ksp.out()));
  check(KSPSetOptionsPrefix(ksp.get(), "damping_"));
  check(KSPSetType(ksp.get(), KSPCG));
  PC pc = nullptr;
  check(KSPGetPC(ksp.get(), &pc));
  check(PCSetType(pc, matrix_type == "sbaij" ? PCJACOBI : PCPBJACOBI));
  constexpr double default_rtol = 1e-8;  // what momentum is balanced to
  check(KSPSetTolerances(ksp.get(), default_rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  check_options([&] { return KSPSetFromOptions(ksp.get()); });
  require_possible(type_of(pc), matrix_type, size_of(comm));
  require_solver(ksp.get(), type_of(pc));
  require_tolerances(ksp.get());
  prefer_natural_norm(ksp.get());
  rebuild_multigrid(pc);
  return ksp;
}

void try_set_up(Mat mat, const std::string& matrix_type) {
  const auto ksp = damping_ksp(PetscObjectComm(reinterpret_cast<PetscObject>(mat)), matrix_type);
  check(KSPSetOperators(ksp.get(), mat, mat));
  PC pc = nullptr;
  VecHandle in, out;
  check(KSPGetPC(ksp.get(), &pc));
  check(MatCreateVecs(mat, in.out(), out.out()));
  check(VecSet(in.get(), 1.0));
  check_options([&]() -> PetscErrorCode {
    if (const auto code = KSPSetUp(ksp.get()); code != 0) return code;
    if (const auto code = KSPSetUpOnBlocks(ksp.get()); code != 0) return code;
    if (type_of(pc) == PCEISENSTAT) return 0;  // crashes outside of a solve
    return PCApply(pc, in.get(), out.get());
  });
}

}  // namespace evert
