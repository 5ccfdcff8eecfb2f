#include "evert/core/petsc.hpp"

#include <string>

namespace evert {

void petsc_failed(PetscErrorCode code, const std::source_location& where) {
  const char* text = nullptr;
  static_cast<void>(PetscErrorMessage(code, &text, nullptr));
  throw PetscFailure("PETSc error " + std::to_string(code) + " (" + (text != nullptr ? text : "unknown") + ") in " +
                     where.function_name() + " at " + where.file_name() + ":" + std::to_string(where.line()));
}

}  // namespace evert
