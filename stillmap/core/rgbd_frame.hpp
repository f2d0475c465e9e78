// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// One colour image and the depth image taken with it, of equal size. A frame is made once and
/// never changed afterwards.
struct RgbdFrame {
  FrameId id;
  Stamp stamp;                 ///< time of the colour image
  double depth_stamp_s = 0.0;  ///< time of the depth image
  ColorImage color;
  GrayImage gray;
  DepthImage depth;
};

using FramePtr = std::shared_ptr<const RgbdFrame>;

}  // namespace stillmap
