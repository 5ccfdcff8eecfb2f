# add_unit_test(<name> SOURCES ... LINK ... [LABELS ...] [TIMEOUT seconds])
#   One GoogleTest binary; ctest lists its cases one by one.
# add_program_test(<name> SOURCES ... [LABELS ...] [TIMEOUT seconds])
#   The same for a binary whose cases start the program `evert`, some of them under mpirun.
# add_mpi_test(<name> SOURCES ... LINK ... [RANKS 1 2 3] [SANITIZED_RANKS ...] [LABELS ...] [TIMEOUT seconds])
#   One binary with the main of tests/mpi, run by mpirun once per number of ranks. Under the sanitizers, where ranks
#   that share a core take minutes, only one and three of RANKS, or two where three is not among them, or what
#   SANITIZED_RANKS says.
# docs/design/testing.md says where tests live and what the labels mean.
include(GoogleTest)
find_package(GTest REQUIRED)

# Every test runs with the same environment: root allowed, oversubscribed, one thread a rank, all ranks on one machine:
# a look for fast networks takes Open MPI a quarter of a second at each of a thousand starts.
set(EVERT_TEST_ENVIRONMENT
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
  OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_yield_when_idle=1
  OMPI_MCA_sharedfp=^sm OMPI_MCA_pml=ob1 HWLOC_HIDE_ERRORS=2
  OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
  "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp:print_suppressions=0"
  "UBSAN_OPTIONS=print_stacktrace=1"
  "EVERT_SOURCE_DIR=${PROJECT_SOURCE_DIR}" "EVERT_SHARED_MESHES=${PROJECT_SOURCE_DIR}/../shared/meshes")

function(add_unit_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} evert_warnings GTest::gtest GTest::gtest_main)
  evert_discover_cases(${name} "unit;${ARG_LABELS}" "${ARG_TIMEOUT}" 1)
endfunction()

function(add_program_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_compile_definitions(${name} PRIVATE
    EVERT_PROGRAM="$<TARGET_FILE:evert>" EVERT_MPIEXEC="${MPIEXEC_EXECUTABLE}")
  target_link_libraries(${name} PRIVATE evert_warnings GTest::gtest GTest::gtest_main)
  add_dependencies(${name} evert)
  # On several ranks, too, they mostly wait for mpirun to start: as many at a time as there are cores.
  evert_discover_cases(${name} "program;${ARG_LABELS}" "${ARG_TIMEOUT}" 1)
endfunction()

# Makes the cases of a GoogleTest binary tests of ctest.
function(evert_discover_cases name labels timeout processors)
  if(NOT timeout)
    set(timeout 600)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 TEST_LIST discovered_${name})
  # Properties that are lists do not survive gtest_discover_tests (CMake 3.25): set after the discovery instead.
  set(properties ${CMAKE_CURRENT_BINARY_DIR}/${name}_properties.cmake)
  file(CONFIGURE OUTPUT ${properties} @ONLY CONTENT [[
if(discovered_@name@)
  set_tests_properties(${discovered_@name@} PROPERTIES
    ENVIRONMENT "@EVERT_TEST_ENVIRONMENT@" LABELS "@labels@" TIMEOUT @timeout@ PROCESSORS @processors@)
endif()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${properties})
endfunction()

function(add_mpi_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK;RANKS;SANITIZED_RANKS;LABELS" ${ARGN})
  if(NOT ARG_RANKS)
    set(ARG_RANKS 1 2 3)
  endif()
  if(EVERT_SANITIZE AND ARG_SANITIZED_RANKS)
    set(ARG_RANKS ${ARG_SANITIZED_RANKS})
  elseif(EVERT_SANITIZE)
    list(FILTER ARG_RANKS EXCLUDE REGEX "^[4-9]$")
    if(3 IN_LIST ARG_RANKS)
      list(REMOVE_ITEM ARG_RANKS 2)
    endif()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 900)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE mpi_test_main ${ARG_LINK} evert_core evert_warnings)
  foreach(ranks IN LISTS ARG_RANKS)
    add_test(NAME ${name}.np${ranks} COMMAND ${MPIEXEC_EXECUTABLE} -n ${ranks} $<TARGET_FILE:${name}>)
    set_tests_properties(${name}.np${ranks} PROPERTIES
      ENVIRONMENT "${EVERT_TEST_ENVIRONMENT}" LABELS "mpi;${ARG_LABELS}" PROCESSORS ${ranks}
      TIMEOUT ${ARG_TIMEOUT} SKIP_RETURN_CODE 77)  # of tests/mpi/main.cpp: all of its cases were skipped
  endforeach()
endfunction()
