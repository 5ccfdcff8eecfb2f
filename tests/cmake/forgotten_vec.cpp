// Forgets to destroy a PETSc vector: LeakSanitizer must see it past what MPI and PETSc themselves leave
// behind.
#include <petscvec.h>

int main(int argc, char** argv) {
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0) return 1;
  Vec forgotten = nullptr;
  if (VecCreateMPI(PETSC_COMM_WORLD, 100, PETSC_DETERMINE, &forgotten) != 0) return 1;
  forgotten = nullptr;
  return PetscFinalize() == 0 ? 0 : 1;
}
