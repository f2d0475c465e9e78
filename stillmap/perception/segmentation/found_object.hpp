// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/segmentation/candidates.hpp"

namespace stillmap {

/// An object with a mask of its own, before it shares the image with others.
struct FoundObject {
  std::string class_name;
  float score = 0;
  PixelBox box;     ///< pixels of the image
  cv::Rect region;  ///< in the image: where the mask is
  cv::Mat1b mask;   ///< as large as the region, not 0 where the object is; empty: no pixels
};

/// Candidates in pixels of the image by the names of their classes, without masks. Those of a class
/// beyond the names are dropped.
[[nodiscard]] std::vector<FoundObject> name_candidates(const std::vector<Candidate>& candidates,
                                                       const std::vector<std::string>& names);

/// The objects of a frame in the order of their scores, the best first, numbered from 1; where
/// masks overlap, the better object has the pixel. Boxes are clipped to the image and objects
/// outside of it dropped; at most 255 are kept. Class names become COCO's.
[[nodiscard]] FrameDetections assemble_detections(const Stamp& stamp,
                                                  cv::Size image,
                                                  std::vector<FoundObject> objects);

}  // namespace stillmap
