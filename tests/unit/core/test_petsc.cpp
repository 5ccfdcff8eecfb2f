#include "evert/core/petsc.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <dlfcn.h>

namespace evert {
namespace {

template <class Function>
Function in_this_process(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

TEST(UseOneBlasThread, LeavesOneUnlessTheUserChose) {
  const auto set_threads = in_this_process<void (*)(int)>("openblas_set_num_threads");
  const auto threads = in_this_process<int (*)()>("openblas_get_num_threads");
  if (set_threads == nullptr || threads == nullptr)
    GTEST_SKIP() << "the BLAS of this machine is not OpenBLAS";
  ::unsetenv("OMP_NUM_THREADS");
  ::setenv("OPENBLAS_NUM_THREADS", "2", 1);
  set_threads(2);
  use_one_blas_thread();
  EXPECT_EQ(threads(), 2);
  ::unsetenv("OPENBLAS_NUM_THREADS");
  use_one_blas_thread();
  EXPECT_EQ(threads(), 1);
}

}  // namespace
}  // namespace evert
