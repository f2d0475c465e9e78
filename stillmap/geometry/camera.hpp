// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

namespace stillmap {

/// How a lens maps rays to raw pixels.
enum class LensModel : std::uint8_t {
  /// Radial and tangential distortion (Brown-Conrady), rational with k4 to k6, as in OpenCV's
  /// calib3d; ROS calls it plumb_bob and rational_polynomial.
  kBrownConrady,
  /// Equidistant fish-eye (Kannala-Brandt) with k1 to k4, as in OpenCV's fisheye.
  kFisheye,
};

struct DepthCamera;

/// A camera: size, focal lengths, lens, and what its depth images are.
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

  /// Distortion of wider lenses: k4 to k6 divide the radial factor; a fish-eye has k1 to k4.
  /// @{
  double k4 = 0, k5 = 0, k6 = 0;
  /// @}
  LensModel lens = LensModel::kBrownConrady;  ///< what k1 to k6, p1 and p2 mean
  /// Whether `depth_factor` was given; else it is the default, and the depth images may tell
  /// another (sensor/depth_unit.hpp).
  bool depth_factor_given = true;
  /// The camera of the depth images; null where they are registered to the color images.
  std::shared_ptr<const DepthCamera> depth_camera = nullptr;

  /// Whether raw and ideal pixels differ.
  [[nodiscard]] bool distorted() const {
    return lens == LensModel::kFisheye || k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0 || k3 != 0 ||
           k4 != 0 || k5 != 0 || k6 != 0;
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

  /// The ideal pixel of a raw pixel: the inverse of distort(), to 1e-9 pixels where there is one.
  /// No ray in front of the camera leads to some raw pixels of a fish-eye of 180 degrees, and to
  /// those beyond the fold of a distortion that folds back: their ideal pixel is that of a ray in
  /// their direction with the slope kSteepest.
  [[nodiscard]] Eigen::Vector2d undistort(const Eigen::Vector2d& raw_px) const;

  /// The slope, as distance from the axis on the plane z = 1, that stands for no ray at all.
  static constexpr double kSteepest = 1e4;

  /// Whether a ray in front of the camera leads to the raw pixel of which undistort() made this
  /// ideal one.
  [[nodiscard]] bool has_ray(const Eigen::Vector2d& ideal_px) const {
    return unproject(ideal_px, 1.0).head<2>().norm() < 0.5 * kSteepest;
  }
};

/// The camera that takes the depth images, where these are not registered to the color images.
struct DepthCamera {
  /// Size and lens of the depth images. Its name, depth factor and readout mean nothing: those of
  /// the color camera hold.
  CameraModel camera;
  /// From the depth camera's coordinates to the color camera's, metres.
  Eigen::Isometry3d T_color_depth = Eigen::Isometry3d::Identity();
};

/// The built-in camera `name`: tum_fr1, tum_fr2, tum_fr3 or bonn. Throws Error, with a hint at the
/// nearest name, for any other name.
[[nodiscard]] CameraModel builtin_camera(std::string_view name);
/// The names that builtin_camera() knows.
[[nodiscard]] std::vector<std::string> builtin_camera_names();

/// Whether two cameras have the same size and lens, bit by bit.
[[nodiscard]] bool same_lens(const CameraModel& a, const CameraModel& b);

/// The normalised ray (x/z, y/z) of every raw pixel, as an image of the camera's size.
[[nodiscard]] cv::Mat2f pixel_rays(const CameraModel& camera);

}  // namespace stillmap
