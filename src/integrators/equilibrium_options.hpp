#pragma once
#include "evert/integrators/equilibrium_solver.hpp"

#include <string>

/// What `-quasistatic_*` may ask for.
namespace evert {

/// Collective. The value of -quasistatic_mat_type: "aij", "baij" or "sbaij". Throws UserError.
[[nodiscard]] std::string quasistatic_matrix_type(MPI_Comm comm);

/// Collective. Newton's method with our defaults; options are not read yet.
[[nodiscard]] SnesHandle quasistatic_snes(MPI_Comm comm, const std::string& matrix_type);

/// Collective. Reads the user's options. Throws UserError for what cannot work.
void read_quasistatic_options(SNES snes, const std::string& matrix_type);

}  // namespace evert
