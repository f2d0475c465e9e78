// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/images.hpp"

namespace stillmap {

struct RangeImageConfig {
  int block_px = 2;
  int rim_blocks = 1;
  double max_missing = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("block_px",
          self.block_px,
          FieldInfo{"edge of the square pixel blocks of a range image", "px", 1, 64});
    visit(
        "rim_blocks",
        self.rim_blocks,
        FieldInfo{"number of neighbouring blocks on each side that a block's least range includes",
                  "",
                  0,
                  16});
    visit(
        "max_missing",
        self.max_missing,
        FieldInfo{"share of missing depth above which the range of a block is unknown", "", 0, 1});
  }
};

/// What a block of pixels measures. Two bytes.
class RangeCell {
 public:
  RangeCell() = default;  ///< nothing
  /// Up to 65 m; what is farther counts as 65 m.
  RangeCell(float range_m, bool moving);

  [[nodiscard]] bool known() const { return bits_ != 0; }
  /// Whether it measures what moves.
  [[nodiscard]] bool moving() const { return (bits_ & kMoving) != 0; }
  /// To 2 mm.
  [[nodiscard]] float range_m() const { return static_cast<float>(bits_ & ~kMoving) * kUnit_m; }

 private:
  static constexpr std::uint16_t kMoving = 0x8000;
  static constexpr float kUnit_m = 0.002F;
  std::uint16_t bits_ = 0;
};

/// How far a frame has seen for certain, for each block of pixels.
struct RangeImage {
  int block_px = 1;
  int columns = 0, rows = 0;
  std::vector<RangeCell> cells;  ///< row by row

  [[nodiscard]] RangeCell at(int row, int column) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

/// What in a frame is not the static world. Images of its size, or empty.
struct DynamicRegions {
  Mask excluded;  ///< pixels whose depth says nothing of the static surface
  Mask moving;    ///< pixels of what is known to move
};

/// The least measured depth (metres) in and around each block: what is nearer is free space there.
///
/// That is on the safe side: the rim of something near is not seen through because a pixel beside
/// it sees the wall behind. Nothing is known of a block where more than `max_missing` of the pixels
/// have no depth, or of one with excluded pixels, except that something moves there: then it has
/// the least depth of the pixels that move. Such blocks change nothing in those around them.
[[nodiscard]] RangeImage range_image(const cv::Mat1f& depth,
                                     const DynamicRegions& dynamic_regions,
                                     const RangeImageConfig& config);

}  // namespace stillmap
