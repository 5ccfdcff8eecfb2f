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

# Optional: the look-up of points far from an obstacle of triangles. Debian ships no CMake package that stands alone,
# and does not install the headers of Boost that those of OpenVDB include.
find_path(EVERT_OPENVDB_HEADERS openvdb/openvdb.h)
find_path(EVERT_BOOST_HEADERS boost/numeric/conversion/conversion_traits.hpp)
find_library(EVERT_OPENVDB_LIBRARY openvdb)
find_library(EVERT_TBB_LIBRARY tbb)
find_library(EVERT_IMATH_LIBRARY NAMES Imath Imath-3_1 Imath-3_2)
mark_as_advanced(EVERT_OPENVDB_HEADERS EVERT_BOOST_HEADERS EVERT_OPENVDB_LIBRARY EVERT_TBB_LIBRARY
                 EVERT_IMATH_LIBRARY)
set(found_openvdb OFF)
if(EVERT_OPENVDB_HEADERS AND EVERT_BOOST_HEADERS AND EVERT_OPENVDB_LIBRARY AND EVERT_TBB_LIBRARY AND EVERT_IMATH_LIBRARY)
  set(found_openvdb ON)
endif()
option(EVERT_OPENVDB "Use OpenVDB (libopenvdb-dev): faster contact with obstacles of triangles" ${found_openvdb})
if(EVERT_OPENVDB AND NOT found_openvdb)
  message(FATAL_ERROR "EVERT_OPENVDB is ON, but OpenVDB, TBB, Imath or Boost was not found: install libopenvdb-dev libboost-dev")
endif()
