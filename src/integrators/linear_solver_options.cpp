#include "linear_solver_options.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"

#include <algorithm>
#include <array>

namespace evert {
namespace {

const std::vector<std::string> all_matrix_types{"shell", "baij", "sbaij", "aij"};

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
      {"none", all_matrix_types},
      {"jacobi", all_matrix_types},
      {"mat", all_matrix_types},
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

/// The words of `list` that `other` has too.
std::vector<std::string> common(const std::vector<std::string>& list, const std::vector<std::string>& other) {
  std::vector<std::string> both;
  std::copy_if(list.begin(), list.end(), std::back_inserter(both),
               [&](const auto& word) { return holds(other, word); });
  return both;
}

// In PETSc's own style, so that -help lists the option.
PetscErrorCode read_matrix_type(MPI_Comm comm, const std::string& prefix, const std::string& help, char* text,
                                std::size_t size) {
  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, prefix.c_str(), "Operator of the solves", nullptr);
  PetscCall(PetscOptionsString("-mat_type", help.c_str(), nullptr, text, text, size, nullptr));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

std::string type_of(PC pc) {
  const char* type = nullptr;
  check(PCGetType(pc, &type));
  return type == nullptr ? "none" : type;
}

/// PETSc finds out in the middle of its set-up, on some ranks before others: decided here beforehand.
void require_matrix(const std::string& prefix, const std::string& name, const std::string& matrix,
                    const std::vector<std::string>& matrices, int ranks) {
  const auto& known = preconditioners();
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name; });
  const auto option = "-" + prefix + "pc_type " + name;
  const auto of_matrix = "-" + prefix + "mat_type ";
  if (name == "shell") {
    std::vector<std::string> names;
    for (const auto& one : known) names.push_back(one.name);
    throw UserError(option + " is not allowed, since evert has none of its own: must be " + list_of(names));
  }
  const std::vector<std::string> assembled(all_matrix_types.begin() + 1, all_matrix_types.end());
  const auto allowed = common(found == known.end() ? assembled : found->matrices, matrices);
  if (matrix == "shell" && !holds(allowed, matrix))
    throw UserError(option + " needs the entries of the matrix: add " + of_matrix + list_of(allowed));
  if (!holds(allowed, matrix))
    throw UserError(option + " does not work with " + of_matrix + matrix + ": must be " + list_of(allowed));
  if (found != known.end() && !found->parallel && ranks > 1)
    throw UserError(option + " works on one rank only: on several, -" + prefix + "pc_type bjacobi -" +
                    prefix + "sub_pc_type " + name + " does the same on each");
}

/// What PETSc takes without a word, and then ends every solve at its first guess or never.
void require_tolerances(KSP ksp, const std::string& prefix) {
  PetscReal rtol = 0;
  PetscReal atol = 0;
  check(KSPGetTolerances(ksp, &rtol, &atol, nullptr, nullptr));
  if (!(rtol >= 0 && rtol < 1)) throw UserError("-" + prefix + "ksp_rtol is not allowed: must be in [0, 1)");
  if (!(atol >= 0)) throw UserError("-" + prefix + "ksp_atol is not allowed: must be >= 0");
}

/// Without iterations, the preconditioner must be a solver.
void require_solver(KSP ksp, const std::string& prefix, const std::string& preconditioner) {
  const std::vector<std::string> direct{"lu", "cholesky", "qr", "svd", "redundant", "ksp"};
  const char* type = nullptr;
  check(KSPGetType(ksp, &type));
  if (std::string(type) == KSPPREONLY && !holds(direct, preconditioner))
    throw UserError("-" + prefix + "ksp_type preonly solves nothing with -" + prefix + "pc_type " +
                    preconditioner + ": must be with " + list_of(direct));
}

}  // namespace

std::string matrix_type(MPI_Comm comm, const std::string& prefix, const std::vector<std::string>& allowed,
                        const std::string& help) {
  std::array<char, 64> text{};
  std::copy(allowed.front().begin(), allowed.front().end(), text.begin());
  check(read_matrix_type(comm, prefix, help, text.data(), text.size()));
  const std::string type = text.data();
  if (!holds(allowed, type))
    throw UserError("-" + prefix + "mat_type " + type + " is not allowed: must be " + list_of(allowed) +
                    did_you_mean(type, allowed));
  return type;
}

void require_possible(KSP ksp, const std::string& prefix, const std::string& matrix,
                      const std::vector<std::string>& allowed) {
  PC pc = nullptr;
  check(KSPGetPC(ksp, &pc));
  require_matrix(prefix, type_of(pc), matrix, allowed,
                 size_of(PetscObjectComm(reinterpret_cast<PetscObject>(ksp))));
  require_solver(ksp, prefix, type_of(pc));
  require_tolerances(ksp, prefix);
}

void try_set_up(KSP ksp) {
  PC pc = nullptr;
  Mat mat = nullptr;
  VecHandle in, out;
  check(KSPGetPC(ksp, &pc));
  check(KSPGetOperators(ksp, &mat, nullptr));
  check(MatCreateVecs(mat, in.out(), out.out()));
  check(VecSet(in.get(), 1.0));
  check_options([&]() -> PetscErrorCode {
    if (const auto code = KSPSetUp(ksp); code != 0) return code;
    if (const auto code = KSPSetUpOnBlocks(ksp); code != 0) return code;
    if (type_of(pc) == PCEISENSTAT) return 0;  // crashes outside of a solve
    return PCApply(pc, in.get(), out.get());
  });
}

void rebuild_multigrid(KSP ksp, const std::string& prefix) {
  PC pc = nullptr;
  check(KSPGetPC(ksp, &pc));
  PetscBool told = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, prefix.c_str(), "-pc_gamg_reuse_interpolation", &told));
  if (told == PETSC_FALSE) check(PCGAMGSetReuseInterpolation(pc, PETSC_FALSE));
}

}  // namespace evert
