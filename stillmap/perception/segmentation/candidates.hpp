// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/segmentation/network_input.hpp"

namespace stillmap {

/// A box that a detector proposes, one of many for the same object.
struct Candidate {
  int label = 0;    ///< class number, from 0
  float score = 0;  ///< in [0, 1]
  PixelBox box;
  int source = 0;  ///< number of the detector's box

  bool operator==(const Candidate&) const = default;
};

/// Whether a score cannot be a probability. Sums of half precision may go a little beyond [0, 1].
[[nodiscard]] bool is_no_probability(float score);

/// The words for such a score in an error message.
[[nodiscard]] std::string no_probability_text(float score);

/// Non-maximum suppression: of candidates of one class that overlap by more than `max_overlap` only
/// the best remains. The result is sorted by descending score, then by source and label. Candidates
/// with an empty or infinite box, or with a NaN score, are dropped; of the rest at most the best
/// thousand are considered.
[[nodiscard]] std::vector<Candidate> suppress_overlaps(std::vector<Candidate> candidates,
                                                       double max_overlap);

/// The candidates with boxes in pixels of the image instead of the input.
[[nodiscard]] std::vector<Candidate> to_image(std::vector<Candidate> candidates,
                                              const InputPlacement& placement);

/// The part of a box inside the image; nothing if it is less than half a pixel wide or high.
[[nodiscard]] std::optional<PixelBox> clip_box(const PixelBox& box, cv::Size image);

/// The pixels of the image whose centre is in the box.
[[nodiscard]] cv::Rect pixels_in(const PixelBox& box, cv::Size image);

}  // namespace stillmap
