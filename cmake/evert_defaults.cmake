# One build type unless told otherwise, C++20 without extensions, binaries in one place.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

# -O3 also with debugging information, so that `dev` tests the code that `release` ships. Lines only: full information
# takes a third longer to build; a debugger that must see variables wants -DCMAKE_BUILD_TYPE=Debug.
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g1")
# Nobody reads errno or floating-point traps; without these two GCC may not vectorise sqrt and selections.
add_compile_options(-fno-math-errno -fno-trapping-math)

# The baseline every binary starts on; the kernels are compiled once more for v3 and v4 and chosen at
# run time (docs/design/cpu-levels.md). Other processors get their compiler's own baseline.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(EVERT_X86 TRUE)
  add_compile_options(-march=x86-64-v2 -mtune=generic)
else()
  set(EVERT_X86 FALSE)
endif()

# With ccache, what one clone has compiled serves all: paths are taken relative to the clone.
find_program(CCACHE ccache)
mark_as_advanced(CCACHE)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()
