#pragma once
#include "evert/core/petsc.hpp"

#include <string>

/// What `-damping_*` may ask for.
namespace evert {

/// Collective. The value of -damping_mat_type: "shell", "baij", "sbaij" or "aij". Throws UserError.
[[nodiscard]] std::string damping_matrix_type(MPI_Comm comm);

/// Collective. Conjugate gradients with our defaults, then the user's options, without an operator. Throws
/// UserError for a preconditioner that cannot work with the matrix type or on this many ranks.
[[nodiscard]] KspHandle damping_ksp(MPI_Comm comm, const std::string& matrix_type);

/// Collective. Sets such a solver up for the assembled `mat` on trial: see try_set_up().
void try_damping_set_up(Mat mat, const std::string& matrix_type);

}  // namespace evert
