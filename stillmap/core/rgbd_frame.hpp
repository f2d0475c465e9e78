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
  FrameId id;                  ///< its position in the sequence
  Stamp stamp;                 ///< time of the colour image
  double depth_stamp_s = 0.0;  ///< time of the depth image; 0: that of the colour image
  ColorImage color;            ///< red, green, blue
  GrayImage gray;              ///< brightness of `color`
  DepthImage depth;            ///< metres along the optical axis; 0 where it is missing
};

/// A frame is shared by all stages and copied by none.
using FramePtr = std::shared_ptr<const RgbdFrame>;

/// Makes a frame of two images of equal size, taken at one time: `color` in the order red, green,
/// blue, `depth` in metres along the optical axis, 0 where it is missing. Images are shared, not
/// copied. The id is not set: a System then counts frames itself. Throws Error for images of
/// unequal size.
[[nodiscard]] RgbdFrame make_frame(double stamp_s, ColorImage color, DepthImage depth);

/// The brightness of a colour image, by the weights of ITU-R BT.601.
[[nodiscard]] GrayImage to_gray(const ColorImage& color);

}  // namespace stillmap
