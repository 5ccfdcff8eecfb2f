# Warnings for our own targets only; -DEVERT_WERROR=ON (dev preset) makes them errors.
option(EVERT_WERROR "Treat warnings as errors" OFF)
add_library(evert_warnings INTERFACE)
target_compile_options(evert_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual
  -Wnull-dereference -Wno-psabi
  $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond;-Wlogical-op>
  # g++ 12 takes the concatenation of strings for a copy onto itself (GCC bug 105651).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  $<$<BOOL:${EVERT_WERROR}>:-Werror>)
