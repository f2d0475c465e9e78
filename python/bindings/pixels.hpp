// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "stillmap/perception/detections/detections.hpp"

namespace stillmap::python {

// The loops over pixels. They know nothing of Python, and are compiled for speed.

/// Depth as frames have it, 0 = missing: the image itself where it already is, else a copy with 0
/// for what is negative, infinite or not a number.
[[nodiscard]] cv::Mat1f with_missing_as_zero(const cv::Mat1f& metres);
/// Metres of a stored depth image, the same bits as read_depth() gives.
[[nodiscard]] cv::Mat1f in_metres(const cv::Mat1w& units, double depth_factor);

/// Sets the ids of the pixels where `mask` (as many bytes as `ids` has pixels) is not 0.
void paint(cv::Mat1b& ids, const std::uint8_t* mask, std::uint8_t id);
/// The detections with the ids 1, 2, ... in the order of the objects. A folder may have any.
[[nodiscard]] FrameDetections numbered_in_order(const FrameDetections& found);
/// The box around the pixels of each id from 1 to `count`; an empty one for an id without pixels.
[[nodiscard]] std::vector<PixelBox> boxes_around(const cv::Mat1b& ids, std::size_t count);

}  // namespace stillmap::python
