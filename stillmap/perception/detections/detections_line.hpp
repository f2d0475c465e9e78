// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// A line of detections.jsonl: the detections of a frame without the mask.
struct DetectionsLine {
  Stamp stamp;
  std::vector<DetectedObject> objects;
};

/// Reads a line. Unknown keys are skipped; class names of VOC become those of COCO. Messages begin
/// with `place` ("file:line"). Throws Error for text that is no JSON or longer than 1 MiB, a stamp
/// that parse_stamp() refuses, an id outside 1 to 255 or repeated, a class that is_class_name()
/// refuses, a score outside [0, 1], and a box that is empty, reversed, not finite, or farther
/// outside the image than the image is large.
[[nodiscard]] DetectionsLine parse_detections_line(std::string_view text,
                                                   cv::Size image,
                                                   const std::string& place);

/// The line of a frame, without its line end. Numbers read back to the same bits. Nothing is
/// checked; whatever parse_detections_line() reads is read again as it was.
[[nodiscard]] std::string format_detections_line(const FrameDetections& frame);

}  // namespace stillmap
