// Part of every executable of the sanitizer build: the few calls in which Open MPI and PETSc forget what they
// allocate, which is not ours to free, with leak detection switched off. Everything else, ours and theirs on
// our behalf, stays under watch: a suppression by library would hide it.
#include <petscsys.h>

#include <dlfcn.h>
#include <sanitizer/lsan_interface.h>

// Also linked into programs that do without MPI.
#pragma weak PMPI_Init
#pragma weak PMPI_Init_thread
#pragma weak PMPI_Finalize
#pragma weak PMPI_File_open
#pragma weak PMPI_File_write_at_all

namespace {

/// Keeps the library of PMIx in memory to the end, so that cmake/lsan.supp can name it.
void keep_pmix() { dlopen("libpmix.so.2", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE); }

}  // namespace

extern "C" {

// --- Open MPI, through MPI's profiling interface

int MPI_Init(int* argc, char*** argv) {
  const __lsan::ScopedDisabler not_ours;
  const int code = PMPI_Init(argc, argv);
  keep_pmix();
  return code;
}

int MPI_Init_thread(int* argc, char*** argv, int required, int* provided) {
  const __lsan::ScopedDisabler not_ours;
  const int code = PMPI_Init_thread(argc, argv, required, provided);
  keep_pmix();
  return code;
}

int MPI_Finalize() {
  const __lsan::ScopedDisabler not_ours;
  return PMPI_Finalize();
}

/// With OMPI_MCA_sharedfp=^sm (src/app/main.cpp) Open MPI 4.1 forgets the name of the file that would keep
/// the shared file pointer.
int MPI_File_open(MPI_Comm comm, const char* path, int mode, MPI_Info info, MPI_File* file) {
  const __lsan::ScopedDisabler not_ours;
  return PMPI_File_open(comm, path, mode, info, file);
}

/// Open MPI 4.1 forgets the list of writing ranks (mca_common_ompio_set_aggregator_props), from 3 ranks on.
int MPI_File_write_at_all(MPI_File file, MPI_Offset offset, const void* data, int count, MPI_Datatype type,
                          MPI_Status* status) {
  const __lsan::ScopedDisabler not_ours;
  return PMPI_File_write_at_all(file, offset, data, count, type, status);
}

// --- PETSc, in front of the function of the library

/// The title of a section of options, which PetscOptionsEnd frees unless an option in between was refused.
PetscErrorCode PetscOptionsBegin_Private(PetscOptionItems* items, MPI_Comm comm, const char prefix[],
                                         const char title[], const char manual_page[]) {
  using Function = decltype(&PetscOptionsBegin_Private);
  static const auto of_petsc = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "PetscOptionsBegin_Private"));
  const __lsan::ScopedDisabler not_ours;
  return of_petsc(items, comm, prefix, title, manual_page);
}

/// What it was writing when a file of -log_view could not be opened.
PetscErrorCode PetscFinalize() {
  using Function = decltype(&PetscFinalize);
  static const auto of_petsc = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "PetscFinalize"));
  const __lsan::ScopedDisabler not_ours;
  return of_petsc();
}

}  // extern "C"
