# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` adds to the libraries, headers and program: a CMake package, so that
# find_package(stillmap) gives stillmap::stillmap (everything) and stillmap::NAME (one module).
include(CMakePackageConfigHelpers)
set(stillmap_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/stillmap)

install(EXPORT stillmap NAMESPACE stillmap:: FILE stillmap-targets.cmake
  DESTINATION ${stillmap_package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/stillmap-config.cmake.in
  ${PROJECT_BINARY_DIR}/stillmap-config.cmake INSTALL_DESTINATION ${stillmap_package_dir}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change interfaces.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/stillmap-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/stillmap-config.cmake
  ${PROJECT_BINARY_DIR}/stillmap-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/opencv_targets.cmake
  DESTINATION ${stillmap_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
