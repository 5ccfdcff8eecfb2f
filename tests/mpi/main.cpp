// The main of every MPI test: PETSc up and down around GoogleTest; a failure on any rank fails all.
#include <gtest/gtest.h>
#include <petscsys.h>

#include <cstdio>

namespace {

/// What ctest takes for "skipped" (SKIP_RETURN_CODE in cmake/evert_tests.cmake).
constexpr int all_skipped = 77;

/// Ranks other than 0 print nothing as they go.
void print_failures(int rank) {
  std::printf("rank %d: failed tests:\n", rank);
  const auto& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s)
    for (int t = 0; t < all.GetTestSuite(s)->total_test_count(); ++t) {
      const auto& test = *all.GetTestSuite(s)->GetTestInfo(t);
      for (int p = 0; p < test.result()->total_part_count(); ++p)
        if (test.result()->GetTestPartResult(p).failed())
          std::printf("  %s: %s\n", test.name(), test.result()->GetTestPartResult(p).message());
    }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0) return 1;
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank != 0) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  int failed = RUN_ALL_TESTS();
  if (rank != 0 && failed != 0) print_failures(rank);
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  if (PetscFinalize() != 0) return 1;
  const auto& all = *testing::UnitTest::GetInstance();
  const bool nothing_ran = all.skipped_test_count() > 0 && all.successful_test_count() == 0;
  return failed == 0 && nothing_ran ? all_skipped : failed;
}
