// Part of every executable of the sanitizer build: what Open MPI allocates while it starts and stops is not
// ours to free. Done here through MPI's profiling interface, so that whatever we leak ourselves, be it
// through PETSc, is found: a suppression by library would hide that.
#include <mpi.h>

#include <dlfcn.h>
#include <sanitizer/lsan_interface.h>

// Also linked into programs that do without MPI.
#pragma weak PMPI_Init_thread
#pragma weak PMPI_Finalize

extern "C" {

int MPI_Init_thread(int* argc, char*** argv, int required, int* provided) {
  const __lsan::ScopedDisabler not_ours;
  const int code = PMPI_Init_thread(argc, argv, required, provided);
  // Keeps the library of PMIx in memory to the end, so that cmake/lsan.supp can name it.
  dlopen("libpmix.so.2", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
  return code;
}

int MPI_Finalize() {
  const __lsan::ScopedDisabler not_ours;
  return PMPI_Finalize();
}

}  // extern "C"
