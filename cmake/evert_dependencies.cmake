# Debian bookworm packages; docs/design/dependencies.md says why each is there. evertConfig.cmake.in finds the same
# ones again for whoever links the installed libraries.
set(EVERT_PETSC PETSc CACHE STRING "pkg-config name of the PETSc to build against: real scalars, double precision")
set(EVERT_SLEPC SLEPc CACHE STRING "pkg-config name of the SLEPc built for that PETSc")
set(EVERT_HDF5 hdf5-openmpi CACHE STRING "pkg-config name of an HDF5 built for the same MPI as PETSc")
mark_as_advanced(EVERT_PETSC EVERT_SLEPC EVERT_HDF5)

find_package(PkgConfig REQUIRED)
set(MPI_CXX_SKIP_MPICXX TRUE)  # the C interface only
find_package(MPI REQUIRED COMPONENTS C CXX)
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET ${EVERT_PETSC}>=3.18)
pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET ${EVERT_SLEPC}>=3.18)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET ${EVERT_HDF5})
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(METIS 5.1 REQUIRED)
add_library(evert::metis ALIAS METIS::METIS)
