# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` adds to the libraries and the program: the public headers and a CMake
# package, so that find_package(stillmap) gives stillmap::stillmap.
include(CMakePackageConfigHelpers)
foreach(header IN LISTS stillmap_public_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
endforeach()
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
