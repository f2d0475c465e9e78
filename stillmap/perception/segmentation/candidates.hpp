// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/segmentation/network_input.hpp"

namespace stillmap {

/// What a detector proposes: one of many boxes for the same thing.
struct Candidate {
  int label = 0;    ///< the number of its class, from 0
  float score = 0;  ///< in [0, 1]
  PixelBox box;
  int source = 0;  ///< which of the detector's boxes it is

  bool operator==(const Candidate&) const = default;
};

/// Of candidates of one class that overlap by more than `max_overlap` only the best stays. The
/// result is sorted by score, the best first, then by source and label. Candidates with a box that
/// is empty or not finite, or a score that is no number, are dropped; of the rest at most the best
/// thousand are looked at.
[[nodiscard]] std::vector<Candidate> suppress_overlaps(std::vector<Candidate> candidates,
                                                       double max_overlap);

/// From the input's pixels to the image's.
[[nodiscard]] std::vector<Candidate> to_image(std::vector<Candidate> candidates,
                                              const InputPlacement& placement);

/// The part of a box that is in the image; nothing when that is less than half a pixel wide or
/// high.
[[nodiscard]] std::optional<PixelBox> clip_box(const PixelBox& box, cv::Size image);

/// The pixels whose middle is in the box and in the image.
[[nodiscard]] cv::Rect pixels_in(const PixelBox& box, cv::Size image);

}  // namespace stillmap
