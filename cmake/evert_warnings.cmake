# Warnings for our own targets only; -DEVERT_WERROR=ON (dev preset) makes them errors.
option(EVERT_WERROR "Treat warnings as errors" OFF)
add_library(evert_warnings INTERFACE)
target_compile_options(evert_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual
  -Wnull-dereference -Wduplicated-cond -Wlogical-op -Wno-psabi
  $<$<BOOL:${EVERT_WERROR}>:-Werror>)
