#include "evert/integrators/spanning_rows.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"

#include "linear_solver_options.hpp"
#include "vec_view.hpp"
#include <string>

namespace evert {
namespace {

const std::string prefix = "projection_";

KspHandle projection_ksp(MPI_Comm comm) {
  KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(comm, ksp.out()));
  check(KSPSetOptionsPrefix(ksp.get(), prefix.c_str()));
  check(KSPSetType(ksp.get(), KSPPREONLY));
  check(KSPGetPC(ksp.get(), &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  constexpr double default_rtol = 1e-12;  // of methods that iterate: what ranks are to agree to
  check(KSPSetTolerances(ksp.get(), default_rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  check_options([&] { return KSPSetFromOptions(ksp.get()); });
  require_possible(ksp.get(), prefix, MATAIJ, {MATAIJ});
  return ksp;
}

/// Where dependent rows delay pivots, MUMPS needs more memory than it has guessed: twice as much, unless
/// -projection_mat_mumps_icntl_14 says another percentage.
void leave_room_for_factors(KSP ksp) {
  constexpr int of_workspace = 14, more = 100;  // ICNTL(14), per cent
  PC pc = nullptr;
  PetscBool cholesky = PETSC_FALSE, mumps = PETSC_FALSE;
  MatSolverType solver = nullptr;
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCCHOLESKY, &cholesky));
  if (cholesky == PETSC_FALSE) return;
  check(PCFactorGetMatSolverType(pc, &solver));
  check(PetscStrcmp(solver, MATSOLVERMUMPS, &mumps));
  if (mumps == PETSC_FALSE) return;
  Mat factors = nullptr;
  check(PCFactorSetUpMatSolverType(pc));
  check(PCFactorGetMatrix(pc, &factors));
  check(MatMumpsSetIcntl(factors, of_workspace, more));
}

PetscInt global_number(const DistributedMesh& mesh, LocalIndex node) {
  return static_cast<PetscInt>(node < mesh.owned_nodes
                                   ? mesh.first_owned + node
                                   : mesh.ghost_globals[static_cast<std::size_t>(node - mesh.owned_nodes)]);
}

}  // namespace

void SpanningRows::read_options(MPI_Comm comm) { static_cast<void>(projection_ksp(comm)); }

SpanningRows::SpanningRows(const DistributedMesh& mesh, std::span<const Nodes> nodes,
                           std::vector<std::int32_t> rows)
    : mesh_(mesh), nodes_(nodes), rows_(std::move(rows)), ksp_(projection_ksp(mesh.comm)) {
  const auto count = static_cast<PetscInt>(rows_.size());
  const PetscInt components = 3 * mesh.owned_nodes;
  check(VecCreateMPI(mesh.comm, count, PETSC_DETERMINE, right_.out()));
  check(VecDuplicate(right_.get(), solution_.out()));
  check(VecDuplicate(right_.get(), diagonal_.out()));
  // The pattern of Jᵀ: a node has the rows of any rank.
  MatHandle pattern;
  const std::vector<Coefficients> zeros(nodes_.size());
  check(MatCreate(mesh.comm, pattern.out()));
  check(MatSetSizes(pattern.get(), components, count, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(pattern.get(), MATPREALLOCATOR));
  check(MatSetUp(pattern.get()));
  fill(pattern.get(), zeros);
  check(MatCreate(mesh.comm, transposed_.out()));
  check(MatSetSizes(transposed_.get(), components, count, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(transposed_.get(), MATAIJ));
  check(MatPreallocatorPreallocate(pattern.get(), PETSC_TRUE, transposed_.get()));
  check(MatDuplicate(transposed_.get(), MAT_DO_NOT_COPY_VALUES, moved_.out()));
  check(MatTransposeMatMult(transposed_.get(), moved_.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT,
                            product_.out()));
  check(MatSetOption(product_.get(), MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(product_.get(), MAT_SPD, PETSC_TRUE));
  check(KSPSetOperators(ksp_.get(), product_.get(), product_.get()));
  leave_room_for_factors(ksp_.get());
}

void SpanningRows::fill(Mat mat, std::span<const Coefficients> values) {
  const auto first = [&] {
    PetscInt begin = 0;
    check(VecGetOwnershipRange(right_.get(), &begin, nullptr));
    return begin;
  }();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto k = static_cast<std::size_t>(rows_[i]);
    const PetscInt column = first + static_cast<PetscInt>(i);
    for (std::size_t a = 0; a < 4; ++a) {
      if (nodes_[k][a] < 0) continue;
      const PetscInt row = 3 * global_number(mesh_, nodes_[k][a]);
      const std::array<PetscInt, 3> at{row, row + 1, row + 2};
      check(MatSetValues(mat, 3, at.data(), 1, &column, values[k][a].components.data(), INSERT_VALUES));
    }
  }
  check(MatAssemblyBegin(mat, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(mat, MAT_FINAL_ASSEMBLY));
}

/// S = Jᵀᵀ (W Jᵀ) + diag(compliances), of the pattern that it has: neither the product nor the factors are
/// analysed again.
void SpanningRows::assemble(std::span<const Coefficients> j, std::span<const Coefficients> jw,
                            std::span<const double> compliances) {
  fill(transposed_.get(), j);
  fill(moved_.get(), jw);
  Mat product = product_.get();
  check(MatTransposeMatMult(transposed_.get(), moved_.get(), MAT_REUSE_MATRIX, PETSC_DEFAULT, &product));
  {
    const VecView diagonal(diagonal_.get());
    for (std::size_t i = 0; i < rows_.size(); ++i)
      diagonal.values()[i] = compliances[static_cast<std::size_t>(rows_[i])];
  }
  check(MatDiagonalSet(product_.get(), diagonal_.get(), ADD_VALUES));
}

void SpanningRows::solve(std::span<double> b) {
  {
    const VecView right(right_.get());
    for (std::size_t i = 0; i < rows_.size(); ++i) right.values()[i] = b[static_cast<std::size_t>(rows_[i])];
  }
  check(KSPSolve(ksp_.get(), right_.get(), solution_.get()));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp_.get(), &reason));
  if (reason < 0)
    throw SimulationError("the solve for filtered elements that span ranks did not converge (" +
                          std::string(KSPConvergedReasons[reason]) +
                          "); a smaller integrator.time_step or another -projection_pc_type may help");
  const VecView solution(solution_.get());
  for (std::size_t i = 0; i < rows_.size(); ++i) b[static_cast<std::size_t>(rows_[i])] = solution.values()[i];
}

}  // namespace evert
