# add_cpu_level_objects(<name> SOURCE kernels.cpp LINK ...): compiles one source once per CPU level, always optimised
# (what the tests run must be what users run), with EVERT_KERNEL_LEVEL defined as the level: v2, v3, v4 on x86-64, else
# `baseline`. Makes the object libraries <name>_<level> and sets <name>_OBJECTS.  docs/design/cpu-levels.md
if(EVERT_X86)
  set(EVERT_CPU_LEVELS v2 v3 v4)
else()
  set(EVERT_CPU_LEVELS baseline)
endif()

function(add_cpu_level_objects name)
  cmake_parse_arguments(ARG "" "SOURCE" "LINK" ${ARGN})
  set(objects)
  foreach(level IN LISTS EVERT_CPU_LEVELS)
    set(target ${name}_${level})
    add_library(${target} OBJECT ${ARG_SOURCE})
    target_compile_definitions(${target} PRIVATE EVERT_KERNEL_LEVEL=${level})
    target_compile_options(${target} PRIVATE -O3)
    if(EVERT_X86)
      target_compile_options(${target} PRIVATE -march=x86-64-${level})
    endif()
    if(level STREQUAL v4)
      # g++ 12 takes the deliberately undefined operands of its own AVX-512 intrinsics for mistakes.
      target_compile_options(${target} PRIVATE -Wno-uninitialized -Wno-maybe-uninitialized)
    endif()
    if(EVERT_SANITIZE)
      # These checks watch every temporary of every pack: with them a kernel takes five minutes to compile, without
      # them ten seconds. Bounds, overflow and the heap stay watched.
      target_compile_options(${target} PRIVATE
        -fno-sanitize-address-use-after-scope -fno-sanitize=null,alignment,object-size)
    endif()
    target_link_libraries(${target} PRIVATE ${ARG_LINK})
    list(APPEND objects $<TARGET_OBJECTS:${target}>)
  endforeach()
  set(${name}_OBJECTS ${objects} PARENT_SCOPE)
endfunction()
