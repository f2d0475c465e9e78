// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/motion/dynamic_objects.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"

namespace stillmap {

/// A frame with the objects that are known of it, and all that can be computed from the two without
/// any other frame.
struct PreparedFrame {
  FramePtr frame;
  FrameObjects objects;
  ImageCorners corners;
  MeasuredObjects measured;  ///< of `objects`; empty when nothing is done about what moves
  double corners_ms = 0, objects_ms = 0;
};

}  // namespace stillmap
