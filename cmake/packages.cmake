# SPDX-License-Identifier: Apache-2.0
# `make deb`: packages for Debian 12, made by CPack from the components that install() names. What is
# installed without a component belongs to the library.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program dev)
if(STILLMAP_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_PACKAGE_NAME stillmap)
set(CPACK_PACKAGE_CONTACT "the stillmap authors <stillmap@localhost>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME stillmap)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "RGB-D SLAM with a clean map of the static world
 The program: trajectory, map and report of a recorded sequence, evaluation, export, rendered sequences.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "npm, python3-onnx, snakemake, sweethome3d-furniture")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libstillmap-dev)
set(CPACK_COMPONENT_DEV_DESCRIPTION "RGB-D SLAM with a clean map of the static world, library
 Headers, static libraries and the CMake package of stillmap.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libyaml-cpp-dev, nlohmann-json3-dev, libceres-dev, \
libopencv-core-dev, libopencv-imgproc-dev, libpng-dev, zlib1g-dev, libdeflate-dev, libjpeg62-turbo-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-stillmap)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "RGB-D SLAM with a clean map of the static world, Python
 The Python package of stillmap: runs, frame by frame on numpy arrays, evaluation.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
include(CPack)
