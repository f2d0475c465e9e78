// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// Brings the images of a depth camera into the view of the color camera.
///
/// Each depth pixel is a small square on the surface that it saw, whose corners it shares with the
/// neighbours on the same surface. The squares are drawn into the color image, the nearest in
/// front. So a larger color image has no holes, and what is hidden from the color camera does not
/// shine through.
class DepthRegistration {
 public:
  /// For a camera that has a depth camera.
  explicit DepthRegistration(const CameraModel& camera);

  /// The depth image as the color camera would take it: of its size, metres along its axis, 0
  /// where the depth camera saw nothing. `depth` has the depth camera's size. May run in any number
  /// of threads.
  [[nodiscard]] DepthImage to_color(const DepthImage& depth) const;

 private:
  CameraModel color_;
  Eigen::Isometry3f T_color_depth_;
  cv::Mat2f rays_;         // of the depth pixels
  cv::Mat2f corner_rays_;  // of their corners: one more each way
};

}  // namespace stillmap
