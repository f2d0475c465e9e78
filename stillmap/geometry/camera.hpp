// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace stillmap {

/// A pinhole camera with Brown-Conrady distortion (the five parameters of OpenCV).
///
/// Camera axes: x right, y down, z forward. A *raw* pixel is a position in the image; the *ideal*
/// pixel is the position of the same ray without distortion (same fx, fy, cx, cy). Features are
/// detected and depth is read at raw pixels; geometry uses ideal pixels.
struct CameraModel {
  std::string name;   ///< of a built-in camera, or of its file
  int width_px = 0;   ///< columns of both images
  int height_px = 0;  ///< rows of both images
  /// Focal lengths and principal point, pixels.
  /// @{
  double fx = 0, fy = 0, cx = 0, cy = 0;
  /// @}
  /// Distortion, on normalised coordinates.
  /// @{
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  /// @}
  double depth_factor = 5000;  ///< units of a stored depth image per metre

  double readout_s = 0;  ///< rolling shutter: time from the first row to the last; 0 = global

  /// Whether any parameter of the distortion is not 0.
  [[nodiscard]] bool distorted() const {
    return k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0 || k3 != 0;
  }

  /// The ideal pixel of a point in camera coordinates with z > 0.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    const double inverse_z = 1.0 / p_camera.z();
    return {fx * p_camera.x() * inverse_z + cx, fy * p_camera.y() * inverse_z + cy};
  }

  /// The point at `depth` metres along the optical axis on the ray of an ideal pixel.
  [[nodiscard]] Eigen::Vector3d unproject(const Eigen::Vector2d& ideal_px, double depth) const {
    return {(ideal_px.x() - cx) / fx * depth, (ideal_px.y() - cy) / fy * depth, depth};
  }

  /// The raw pixel of an ideal pixel.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal_px) const;

  /// The ideal pixel of a raw pixel: the inverse of distort(), to 1e-9 pixels inside the image.
  [[nodiscard]] Eigen::Vector2d undistort(const Eigen::Vector2d& raw_px) const;
};

/// The built-in camera `name`: tum_fr1, tum_fr2, tum_fr3 or bonn. Throws Error, with a hint at the
/// nearest name, for any other name.
[[nodiscard]] CameraModel builtin_camera(std::string_view name);
/// The names that builtin_camera() knows.
[[nodiscard]] std::vector<std::string> builtin_camera_names();

/// The normalised ray (x/z, y/z) of every raw pixel, as an image of the camera's size.
[[nodiscard]] cv::Mat2f pixel_rays(const CameraModel& camera);

}  // namespace stillmap
