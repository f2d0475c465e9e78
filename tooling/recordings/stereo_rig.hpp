// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

/// Two cameras side by side, as they were calibrated.
struct StereoCalibration {
  CameraModel left;                ///< Brown-Conrady lens, or none
  CameraModel right;               ///< of the size of the left one
  Eigen::Isometry3d T_left_right;  ///< from the right camera's coordinates to the left one's
};

/// Makes rectified pairs: images of two equal cameras without distortion, the right one moved along
/// the x axis of the left, so that a point is in the same row of both. Functions may run in any
/// number of threads.
class StereoRig {
 public:
  /// Rectifies by OpenCV's stereoRectify(), without pixels that the lenses did not see; images that
  /// are rectified already stay as they are. Throws Error, beginning with `place`, for cameras that
  /// are not side by side with the right one on the right.
  StereoRig(const StereoCalibration& calibration, const std::string& place);

  /// The rectified left camera.
  [[nodiscard]] const CameraModel& camera() const { return camera_; }
  [[nodiscard]] double baseline_m() const { return baseline_m_; }
  /// From the rectified left camera's coordinates to those of the left camera as it is.
  [[nodiscard]] const Eigen::Isometry3d& T_left_rectified() const { return T_left_rectified_; }

  [[nodiscard]] ColorImage rectified_left(const ColorImage& left) const;
  [[nodiscard]] ColorImage rectified_right(const ColorImage& right) const;

  /// The depth of a rectified left image, from the disparity d in pixels: focal length * baseline /
  /// d. Semi-global matching (Hirschmueller 2008, OpenCV's StereoSGBM) with a check of left against
  /// right and a filter for speckles; 0 where there is no clear match. Disparities are at least
  /// kLeastDisparityPx and at most a sixth of the width.
  [[nodiscard]] DepthImage depth(const ColorImage& left, const ColorImage& right) const;

  /// The noise that follows from that of disparities.
  [[nodiscard]] DepthNoise noise() const;

  static constexpr double kLeastDisparityPx = 3, kDisparitySigmaPx = 1;

 private:
  struct Maps {
    cv::Mat x, y;  // empty: images are rectified already
  };
  void rectify(const StereoCalibration& calibration, const std::string& place);

  CameraModel camera_;
  double baseline_m_ = 0;
  Eigen::Isometry3d T_left_rectified_ = Eigen::Isometry3d::Identity();
  Maps left_, right_;
};

}  // namespace stillmap
