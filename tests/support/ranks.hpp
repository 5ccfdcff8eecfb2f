#pragma once
#include "evert/core/collective.hpp"

#include <petscsys.h>

#include "tests/support/thorough.hpp"

namespace evert::test {

/// Whether several ranks would show again what one has shown, as a case says that skips itself then;
/// EVERT_THOROUGH=1 runs it on all.
inline bool shown_on_one_rank() { return size_of(PETSC_COMM_WORLD) > 1 && !thorough(); }

}  // namespace evert::test
