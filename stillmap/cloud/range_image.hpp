// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"

namespace stillmap {

struct RangeImageConfig {
  int block_px = 2;
  int rim_blocks = 1;
  double max_missing = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("block_px",
          self.block_px,
          FieldInfo{"how far is seen is kept for square blocks of pixels of this side", "px", 1, 64});
    visit("rim_blocks",
          self.rim_blocks,
          FieldInfo{"it is the least over so many blocks on each side", "", 0, 16});
    visit("max_missing",
          self.max_missing,
          FieldInfo{"nothing is known of a block that lacks depth in more of its pixels", "", 0, 1});
  }
};

/// How far a frame has seen for certain, for each block of pixels. Two bytes a block.
struct RangeImage {
  cv::Mat1w millimetres;  ///< 0 = not known
  int block_px = 1;
};

/// The least measured depth (metres) in and around each block: what is nearer is free space there.
///
/// That is on the safe side: the rim of something near is not seen through because a pixel beside
/// it sees the wall behind. A block is not known where any of its pixels is not 0 in `dynamic` (of
/// the depth image's size, or empty), or where more than `max_missing` of them have no depth; what
/// is not known around it changes nothing.
[[nodiscard]] RangeImage range_image(const cv::Mat1f& depth,
                                     const cv::Mat1b& dynamic,
                                     const RangeImageConfig& config);

}  // namespace stillmap
