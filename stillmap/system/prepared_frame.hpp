// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/motion/dynamic_objects.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"

namespace stillmap {

/// A frame with its known objects, and everything that can be computed from both without any other
/// frame.
struct PreparedFrame {
  FramePtr frame;
  FrameObjects objects;
  ImageCorners corners;
  MeasuredObjects measured;  ///< of `objects`; empty when the mode is `off`
  double corners_ms = 0, objects_ms = 0;
};

}  // namespace stillmap
