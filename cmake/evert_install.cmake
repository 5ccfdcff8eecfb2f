# cmake --install: the program, every layer as a library, the public headers, and the package that find_package(evert)
# reads. Users link evert::evert (all layers) or single layers such as evert::forces.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(EVERT_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/evert)

get_property(layers GLOBAL PROPERTY EVERT_LAYER_TARGETS)
add_library(evert_all INTERFACE)
set_target_properties(evert_all PROPERTIES EXPORT_NAME evert)
target_link_libraries(evert_all INTERFACE ${layers})

install(TARGETS ${layers} evert_all EXPORT evertTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT evertTargets NAMESPACE evert:: DESTINATION ${EVERT_INSTALL_CMAKEDIR})
install(DIRECTORY include/evert TYPE INCLUDE FILES_MATCHING PATTERN *.hpp)
if(TARGET evert)
  install(TARGETS evert RUNTIME)
endif()

configure_package_config_file(cmake/evertConfig.cmake.in evertConfig.cmake
  INSTALL_DESTINATION ${EVERT_INSTALL_CMAKEDIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(evertConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/evertConfig.cmake ${PROJECT_BINARY_DIR}/evertConfigVersion.cmake
  cmake/FindMETIS.cmake DESTINATION ${EVERT_INSTALL_CMAKEDIR})

install(DIRECTORY examples docs DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
install(FILES README.md LICENSE CHANGELOG.md TYPE DOC)
