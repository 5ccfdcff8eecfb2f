#include "evert/core/petsc.hpp"

#include "evert/core/error.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <string>

namespace evert {
namespace {

/// An error handler of PETSc's that keeps the first complaint, where its own would print all of them.
PetscErrorCode keep_message(MPI_Comm /*comm*/, int /*line*/, const char* /*function*/, const char* /*file*/,
                            PetscErrorCode code, PetscErrorType type, const char* text, void* context) {
  auto& message = *static_cast<std::string*>(context);
  if (type == PETSC_ERROR_INITIAL && text != nullptr && message.empty()) message = text;
  return code;
}

}  // namespace

void petsc_failed(PetscErrorCode code, const std::source_location& where) {
  const char* text = nullptr;
  static_cast<void>(PetscErrorMessage(code, &text, nullptr));
  throw PetscFailure("PETSc error " + std::to_string(code) + " (" + (text != nullptr ? text : "unknown") +
                     ") in " + where.function_name() + " at " + where.file_name() + ":" +
                     std::to_string(where.line()));
}

void use_one_blas_thread() {
  for (const char* chosen : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"})
    if (std::getenv(chosen) != nullptr) return;
  // Which BLAS it is shows at run time only: Debian links all programs to an alternative.
  using SetThreads = void (*)(int);
  const auto set_threads = reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(1);
}

std::string refusal_of(const std::function<PetscErrorCode()>& calls) {
  std::string message;
  check(PetscPushErrorHandler(keep_message, &message));
  const auto code = calls();
  check(PetscPopErrorHandler());
  if (code == 0) return "";
  return message.empty() ? "error " + std::to_string(code) : message.substr(0, message.find('\n'));
}

void check_options(const std::function<PetscErrorCode()>& calls) {
  const auto refusal = refusal_of(calls);
  if (!refusal.empty()) throw UserError("PETSc refuses an option: " + refusal);
}

}  // namespace evert
