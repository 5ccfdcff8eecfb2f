#pragma once
#include "evert/core/petsc.hpp"

#include <string>
#include <vector>

/// What the options of our linear solvers have in common. `prefix` is "damping_" or "quasistatic_".
namespace evert {

/// Collective. The value of -PREFIXmat_type, one of `allowed`, whose first is the default; `help` is its line
/// in -help. Throws UserError.
[[nodiscard]] std::string matrix_type(MPI_Comm comm, const std::string& prefix,
                                      const std::vector<std::string>& allowed, const std::string& help);

/// Throws UserError for a preconditioner that cannot work with the matrix type or on this many ranks, for a
/// Krylov method that solves nothing with it, and for tolerances that end every solve at its first guess or
/// never. `allowed` are the matrix types of the solver.
void require_possible(KSP ksp, const std::string& prefix, const std::string& matrix,
                      const std::vector<std::string>& allowed);

/// Collective. Sets `ksp` up for its operators on trial and preconditions a vector. Preconditioners of
/// several parts read the options of their parts only then: so options that nobody reads are noticed before
/// the run, and what PETSc refuses becomes a UserError.
void try_set_up(KSP ksp);

/// GAMG keeps its first coarse spaces and eigenvalues unless told otherwise; ours change by orders of
/// magnitude with the step and the material.
void rebuild_multigrid(KSP ksp, const std::string& prefix);

}  // namespace evert
