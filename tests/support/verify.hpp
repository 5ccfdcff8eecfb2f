#pragma once
#include <petscsys.h>

#include <cstdio>

namespace evert::test {

/// Rank 0 prints a row of a table of verifications: what, what theory says, what was found, and how far apart
/// they may be, as `expected` and `tolerance` are written.
inline void print_verification(const char* what, const char* expected, double found, const char* tolerance) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) std::printf("verify: %s | %s | %.6g | %s\n", what, expected, found, tolerance);
}

}  // namespace evert::test
