// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/perception/motion/dynamic_objects.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"

namespace stillmap {

/// What can be worked out of a frame, and the objects in it, without any other frame.
struct PreparedFrame {
  ImageCorners corners;
  MeasuredObjects objects;  ///< empty when nothing is done about what moves
  double corners_ms = 0, objects_ms = 0;
};

}  // namespace stillmap
