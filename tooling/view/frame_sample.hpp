// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/system/results.hpp"
#include "tooling/browser/ghost_points.hpp"

namespace stillmap {

/// A frame with its result; shares the pixels of both.
using ViewedSample = std::pair<RgbdFrame, FrameResult>;

/// The rays of every n-th pixel of every n-th row of a camera.
class PixelGrid {
 public:
  /// `width`: about how many pixels of a row are taken.
  PixelGrid(const CameraModel& camera, int width);

  struct Pixel {
    int row = 0, column = 0;
    float x = 0, y = 0;  ///< of the ray at z = 1
  };
  [[nodiscard]] const std::vector<Pixel>& pixels() const { return pixels_; }
  [[nodiscard]] int step() const { return step_; }

 private:
  int step_;
  std::vector<Pixel> pixels_;
};

/// The map of a run that goes on: what some frames saw, without the pixels that no feature may have
/// (what moves), without edges of depth, and one point a voxel. It is for looking at: the run's own
/// map (free space, resting places, poses corrected later) takes its place at the end.
class GrowingMap {
 public:
  explicit GrowingMap(const CameraModel& camera);

  /// The points that a frame adds, in world coordinates. Nothing without a pose.
  [[nodiscard]] PointCloud add(const ViewedSample& sample);

  static constexpr double kVoxel_m = 0.02;
  static constexpr std::size_t kMostPoints = 1'000'000;

 private:
  PixelGrid grid_;
  std::unordered_set<std::uint64_t> seen_;  // voxels
};

/// The points of dynamic objects on a grid of pixels.
[[nodiscard]] GhostPoints ghost_points(const ViewedSample& sample, const PixelGrid& grid);

/// The features of a frame: of each x and y in quarters of a pixel, and the place of its style in
/// verdict_styles(). Features outside the image are left out.
[[nodiscard]] std::vector<std::uint16_t> feature_marks(const ViewedSample& sample);

/// The masks of a frame, reduced: bit 0 the network's, bit 1 extended, bit 2 jumps of depth. Rows
/// from above, as runs of equal values: value, length, value, length, ...
struct MaskRuns {
  int width_px = 0, height_px = 0;  ///< 0 without any mask
  std::vector<std::uint16_t> runs;
};
/// `width_px` at most; masks of another size than the image are left out.
[[nodiscard]] MaskRuns mask_runs(const ViewedSample& sample, int width_px);

/// The image as JPEG, reduced if wider than `width_px`; empty for an empty image.
[[nodiscard]] std::vector<std::uint8_t> picture_jpeg(const ColorImage& image, int width_px);

}  // namespace stillmap
