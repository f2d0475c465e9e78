// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/segmentation/candidates.hpp"

namespace stillmap {

/// An object with its own mask, before overlaps with other objects are resolved.
struct FoundObject {
  std::string class_name;
  float score = 0;
  PixelBox box;        ///< pixels of the image
  cv::Rect region;     ///< the area of the mask in the image
  cv::Mat1b mask;      ///< of the size of the region, not 0 on the object; empty: no mask
  bool rough = false;  ///< whether the mask is to be refined by depth (PixelSource::kRoughNetwork)
};

/// Candidates (in pixels of the image) as objects without masks, with the names of their classes.
/// Candidates whose class has no name are dropped.
[[nodiscard]] std::vector<FoundObject> name_candidates(const std::vector<Candidate>& candidates,
                                                       const std::vector<std::string>& names);

/// The detections of a frame by descending score, numbered from 1. Where masks overlap, the object
/// of the higher score has the pixel. Boxes are clipped to the image; objects outside it are
/// dropped; at most 255 are kept. Class names become those of COCO.
[[nodiscard]] FrameDetections assemble_detections(const Stamp& stamp,
                                                  cv::Size image,
                                                  std::vector<FoundObject> objects);

}  // namespace stillmap
