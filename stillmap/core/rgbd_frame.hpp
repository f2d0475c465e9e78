// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// One colour image and the depth image that goes with it, of equal size. Made once by a reader,
/// never changed afterwards.
struct RgbdFrame {
  FrameId id;
  Stamp stamp;                 ///< of the colour image; it is the frame's stamp
  double depth_stamp_s = 0.0;  ///< when the depth image was taken
  ColorImage color;
  GrayImage gray;
  DepthImage depth;
};

using FramePtr = std::shared_ptr<const RgbdFrame>;

}  // namespace stillmap
