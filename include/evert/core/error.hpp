#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

/// The three tiers of errors: what a user can mend (UserError), what only we can mend (EVERT_ASSERT), and
/// what PETSc or MPI report (PetscFailure, thrown by check() in core/petsc.hpp).
namespace evert {

/// Bad input: one sentence that says what is wrong, where, and what is allowed. Exit code 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The simulation cannot go on (non-finite state, solver not converged). Exit code 3.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The candidate closest to `word` in edit distance, or "" when none is close enough to be meant.
[[nodiscard]] std::string nearest_match(std::string_view word, std::span<const std::string> candidates);

/// " (did you mean 'x'?)" for the nearest match, or "".
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

/// "a, b or c".
[[nodiscard]] std::string list_of(std::span<const std::string> words);

[[noreturn]] void assertion_failed(const char* expression, const char* file, int line,
                                   const std::string& values);

}  // namespace evert

/// A bug of ours: prints the expression, the values and the rank, and aborts all ranks. Stays on in release
/// builds; not for inner loops.
#define EVERT_ASSERT(expression, values)                                                     \
  do {                                                                                       \
    if (!(expression)) ::evert::assertion_failed(#expression, __FILE__, __LINE__, (values)); \
  } while (false)
