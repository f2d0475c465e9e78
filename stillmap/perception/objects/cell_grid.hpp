// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/depth_planes.hpp"

namespace stillmap {

/// A box and its surroundings in cells of several pixels, each with the depth of its middle, to
/// tell the cells of the object from others.
class CellGrid {
 public:
  /// `rough_id` is the object's id in `mask`; 0 if only its box is known. Cells of other objects in
  /// `mask` have no depth.
  CellGrid(const DepthImage& depth, const ObjectMask& mask, const PixelBox& box, int rough_id);

  /// The strongest layer in the middle of the box, or a nearer one that is nearly as strong; of
  /// several the one closest to `expected_m`.
  [[nodiscard]] std::optional<float> layer(std::optional<float> expected_m) const;

  /// Decides the side of every cell with depth.
  void divide(float layer_m);

  /// The share of the rough mask's cells that have depth.
  [[nodiscard]] double measured_share() const;

  /// Whether divide() has given a cell to the object.
  [[nodiscard]] bool is_object(int i) const { return side(i) == Side::kObject; }
  [[nodiscard]] int size() const { return columns_ * rows_; }
  [[nodiscard]] cv::Rect cell(int i) const {
    return cv::Rect(
        area_.x + i % columns_ * stride_, area_.y + i / columns_ * stride_, stride_, stride_);
  }
  /// Metres; 0 where there is none.
  [[nodiscard]] float depth(int i) const { return depth_[static_cast<std::size_t>(i)]; }

 private:
  enum class Side : std::uint8_t { kUndecided, kObject, kOther };

  [[nodiscard]] Side side(int i) const { return side_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] cv::Point pixel(int i) const {
    return cell(i).tl() + cv::Point(stride_ / 2, stride_ / 2);
  }
  /// 0 in the middle of the box, 1 at the middle of its sides.
  [[nodiscard]] double off_middle(int i) const;
  [[nodiscard]] double weight(int i) const;
  [[nodiscard]] bool in_box(int i) const;
  /// The path length that a rough mask adds to a step of the side of `from`.
  [[nodiscard]] float doubt(int from, int to) const;
  /// Whether a cell at the object's layer certainly belongs to it.
  [[nodiscard]] bool is_core(int i) const;

  void divide_by_paths(float layer_m);
  void mark_certain(float layer_m);
  /// Adds parts that end inside the box, as floors and walls do not: a seat below an arm, a leg.
  void claim_enclosed_parts(float layer_m);
  /// Removes planes that go on outside the box: the desk under somebody's arms, the wall with a
  /// picture of somebody. What is within noise of such a plane does no harm on a map.
  void leave_out_planes();
  /// The lesser extent of a plane in itself: of a rectangle as wide, whatever the camera's angle.
  [[nodiscard]] double width_m(const PlanarPart& plane) const;

  template <class Visit>
  void visit_neighbours(int i, const Visit& visit) const {
    const int column = i % columns_;
    if (column > 0) visit(i - 1);
    if (column + 1 < columns_) visit(i + 1);
    if (i >= columns_) visit(i - columns_);
    if (i + columns_ < size()) visit(i + columns_);
  }

  PixelBox box_;
  bool is_rough_;
  int stride_ = 2;
  double focal_px_ = 0;
  cv::Rect area_;
  int columns_ = 0, rows_ = 0;
  std::vector<float> depth_;
  std::vector<Side> side_;
  std::vector<std::uint8_t> own_;  // 1 in the rough mask
};

}  // namespace stillmap
