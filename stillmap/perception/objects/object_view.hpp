// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// Some pixels of an image: those of `area` that are not 0 in `pixels`, which is of its size.
struct PixelPatch {
  cv::Rect area;
  cv::Mat1b pixels;
};

/// An object as a frame has it.
struct ObjectView {
  const DepthImage& depth;
  const ObjectMask& mask;
  int id = 0;
  PixelBox box;
};

}  // namespace stillmap
