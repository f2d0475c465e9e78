# SPDX-License-Identifier: Apache-2.0
# The front door: every header that is installed, and no other. They include each other and the
# headers of Eigen, OpenCV's core and fmt alone; tests/consumer is compiled against them.
set(stillmap_public_headers
  stillmap/core/error.hpp
  stillmap/core/ids.hpp
  stillmap/core/images.hpp
  stillmap/core/point_cloud.hpp
  stillmap/core/rgbd_frame.hpp
  stillmap/core/status.hpp
  stillmap/core/trajectory.hpp
  stillmap/geometry/camera.hpp
  stillmap/perception/detections/detections.hpp
  stillmap/perception/objects/frame_objects.hpp
  stillmap/perception/objects/object_finder.hpp
  stillmap/perception/objects/object_state.hpp
  stillmap/perception/segmentation/segmenter.hpp
  stillmap/sensor/frame_stream.hpp
  stillmap/sensor/open_sequence.hpp
  stillmap/system/observer.hpp
  stillmap/system/output.hpp
  stillmap/system/results.hpp
  stillmap/system/settings.hpp
  stillmap/system/system.hpp)
list(LENGTH stillmap_public_headers count)
if(count GREATER 20)
  message(FATAL_ERROR "cmake/public_headers.cmake: ${count} headers are installed; at most 20, so that one can read them all")
endif()
