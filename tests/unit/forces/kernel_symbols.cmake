# cmake -DNM=nm -DLEVEL=v3 -DREGISTER_BYTES=32 -DOBJECT=level.cpp.o [-DMAY_HAVE_NONE=ON] -P kernel_symbols.cmake
#
# Every weak definition in the kernels of a CPU level must carry the pack type of that level in its name. Any other one
# may be defined by another object too, and then the linker keeps one of them, perhaps the one an older CPU cannot run.
execute_process(COMMAND ${NM} --defined-only --format=posix ${OBJECT} OUTPUT_VARIABLE symbols RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR symbols STREQUAL "")
  message(FATAL_ERROR "nm cannot read ${OBJECT}")
endif()
string(REPLACE "\n" ";" symbols "${symbols}")
math(EXPR doubles "${REGISTER_BYTES} / 8")
math(EXPR floats "${REGISTER_BYTES} / 4")
set(pack "BasicPackI(dLm${doubles}|fLm${floats})E")  # BasicPack<double, doubles>, BasicPack<float, floats>
set(own 0)
set(foreign "")
foreach(symbol IN LISTS symbols)
  if(NOT symbol MATCHES "^([^ ]+) ([WwVvu]) ")
    continue()
  endif()
  set(name "${CMAKE_MATCH_1}")
  if(name MATCHES "${pack}")
    math(EXPR own "${own} + 1")
  elseif(NOT name MATCHES "^DW\\.ref\\.")  # a pointer to the exception personality, the same at every level
    string(APPEND foreign "\n  ${name}")
  endif()
endforeach()
if(own EQUAL 0 AND NOT MAY_HAVE_NONE)
  message(FATAL_ERROR "no weak symbol of level ${LEVEL} in ${OBJECT}: is this the right object?")
endif()
if(NOT foreign STREQUAL "")
  message(FATAL_ERROR "weak symbols of ${OBJECT} that other objects may share:${foreign}")
endif()
message(STATUS "${LEVEL}: ${own} weak symbols, all of packs of ${REGISTER_BYTES} bytes")
