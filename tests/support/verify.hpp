#pragma once
#include "evert/core/collective.hpp"

#include <petscsys.h>

#include <cstdio>
#include <string>

/// The lines that scripts/verify makes docs/verification.md of.
namespace evert::test {

/// Prints "verify: what | expected | found | tolerance" from rank 0. Not collective.
inline void verify(const std::string& what, const std::string& expected, double found,
                   const std::string& tolerance) {
  if (rank_of(PETSC_COMM_WORLD) == 0)
    std::printf("verify: %s | %s | %.6g | %s\n", what.c_str(), expected.c_str(), found, tolerance.c_str());
}

}  // namespace evert::test
