#pragma once
#include <cstdlib>

namespace evert::test {

/// Whether to do also what takes minutes: EVERT_THOROUGH=1.  docs/design/testing.md
inline bool thorough() { return std::getenv("EVERT_THOROUGH") != nullptr; }

}  // namespace evert::test
