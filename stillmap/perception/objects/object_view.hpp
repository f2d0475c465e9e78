// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// A set of pixels of an image: those of `area` that are not 0 in `pixels`, which has the size of
/// `area`.
struct PixelPatch {
  cv::Rect area;
  cv::Mat1b pixels;
};

/// Gives `id` the pixels of a patch that no object has.
void paint(ObjectMask& mask, const PixelPatch& patch, std::uint8_t id);

/// The pixels of an object in a frame.
struct ObjectView {
  const DepthImage& depth;
  const ObjectMask& mask;
  int id = 0;
  PixelBox box;
};

}  // namespace stillmap
