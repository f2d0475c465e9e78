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

/// The range that a block of pixels measures, in two bytes.
class RangeCell {
 public:
  RangeCell() = default;  ///< unknown
  /// `range_m` is clamped to 65 m.
  RangeCell(float range_m, bool moving);

  [[nodiscard]] bool known() const { return bits_ != 0; }
  /// Whether the block measures a moving object.
  [[nodiscard]] bool moving() const { return (bits_ & kMoving) != 0; }
  /// The range, rounded to 2 mm.
  [[nodiscard]] float range_m() const { return static_cast<float>(bits_ & ~kMoving) * kUnit_m; }

 private:
  static constexpr std::uint16_t kMoving = 0x8000;
  static constexpr float kUnit_m = 0.002F;
  std::uint16_t bits_ = 0;
};

/// The range of certain free space of a frame, for each block of pixels.
struct RangeImage {
  int block_px = 1;
  int columns = 0, rows = 0;
  std::vector<RangeCell> cells;  ///< row by row

  [[nodiscard]] RangeCell at(int row, int column) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

/// The pixels of a frame that are not static. Masks of its size, or empty.
struct DynamicRegions {
  Mask excluded;  ///< pixels whose depth is not used for the static surface
  Mask moving;    ///< pixels of objects known to move
};

/// The least measured depth (metres) in and around each block: space nearer than that is free.
///
/// The least depth is the safe choice: the rim of a near object is not seen through only because a
/// pixel beside it sees the wall behind. The range of a block is unknown when more than
/// `max_missing` of its pixels have no depth, or when it has excluded pixels. If some of these are
/// moving, the block is marked as moving and has the least depth of its moving pixels. Such blocks
/// do not affect the blocks around them.
[[nodiscard]] RangeImage range_image(const cv::Mat1f& depth,
                                     const DynamicRegions& dynamic_regions,
                                     const RangeImageConfig& config);

}  // namespace stillmap
