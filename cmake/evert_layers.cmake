# The layers, bottom first (docs/design/layers.md). cmake/check_layers enforces the order in CI.
set(EVERT_LAYERS core math mesh elements materials forces filter contact topology integrators sim io scene app)

# add_layer(<name> SOURCES a.cpp ... [LINK layer-or-target ...])
# One library per layer: evert_<name>, alias evert::<name>, headers in include/evert/<name>.
function(add_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(ARG_SOURCES)
    add_library(evert_${name} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(evert_${name} PRIVATE $<BUILD_INTERFACE:evert_warnings>)
  else()
    add_library(evert_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(evert::${name} ALIAS evert_${name})
  set_target_properties(evert_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(evert_${name} ${scope} cxx_std_20)
  target_include_directories(evert_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(evert_${name} ${scope} ${ARG_LINK})
  set_property(GLOBAL APPEND PROPERTY EVERT_LAYER_TARGETS evert_${name})
endfunction()
