# SPDX-License-Identifier: Apache-2.0
# OpenCV's targets opencv_core, opencv_imgproc, ...: from its own CMake package where that is
# installed, else from headers and libraries alone. Debian puts the CMake package into libopencv-dev,
# which pulls in some 500 MB (GDAL, VTK, Qt) that nothing here uses.
set(stillmap_opencv_modules core imgproc)
if(STILLMAP_BUILD_TOOLING) # depth of stereo pairs
  list(APPEND stillmap_opencv_modules calib3d)
endif()
if(STILLMAP_BUILD_TESTS) # what ours is compared with
  list(APPEND stillmap_opencv_modules features2d calib3d)
  list(REMOVE_DUPLICATES stillmap_opencv_modules)
endif()
find_package(OpenCV 4.5 CONFIG QUIET COMPONENTS ${stillmap_opencv_modules})
if(NOT OpenCV_FOUND)
  find_path(STILLMAP_OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
  foreach(module IN LISTS stillmap_opencv_modules)
    find_library(STILLMAP_OPENCV_${module} opencv_${module} REQUIRED)
    if(NOT TARGET opencv_${module})
      add_library(opencv_${module} SHARED IMPORTED)
      set_target_properties(opencv_${module} PROPERTIES
        IMPORTED_LOCATION ${STILLMAP_OPENCV_${module}}
        INTERFACE_INCLUDE_DIRECTORIES ${STILLMAP_OPENCV_INCLUDE})
    endif()
  endforeach()
endif()
