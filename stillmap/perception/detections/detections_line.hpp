// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// A line of detections.jsonl: all about a frame but its mask.
struct DetectionsLine {
  Stamp stamp;
  std::vector<DetectedObject> objects;
};

/// Reads a line; keys that are not known are skipped. Names of classes that VOC spells otherwise
/// become COCO's. `place` ("file:line") starts the messages. Throws Error for what is no JSON or
/// longer than 1 MiB, a stamp that is not the text of a plain number (digits, maybe a point and
/// digits), an id outside 1 to 255 or that stands twice, a class that is not 1 to 64 printable
/// characters, a score outside [0, 1], and a box that is empty, reversed, not finite or reaches
/// farther out of the image than the image is large.
[[nodiscard]] DetectionsLine parse_detections_line(std::string_view text,
                                                   cv::Size image,
                                                   const std::string& place);

/// The line of a frame, without its end. Numbers are written so that reading gives the same bits;
/// nothing is checked.
[[nodiscard]] std::string format_detections_line(const FrameDetections& frame);

/// Whether a text is digits, maybe followed by a point and digits, at most 32 characters in all:
/// what may be a stamp and hence the name of a file.
[[nodiscard]] bool is_plain_number(std::string_view text);

}  // namespace stillmap
