// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/types.hpp>

#include "stillmap/perception/detections/detections.hpp"

namespace stillmap::python {

/// The detections, if they can be those of an image of this size. Throws Error as for a line of a
/// detections folder.
[[nodiscard]] FrameDetections checked_detections(FrameDetections detections, cv::Size image);

}  // namespace stillmap::python
