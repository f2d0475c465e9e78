// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "stillmap/core/camera.hpp"
#include "stillmap/core/se3.hpp"

namespace stillmap {

/// A feature as a measurement of a point: its ideal pixel and, where known, the inverse of its
/// depth.
///
/// The inverse depth is what a structured-light or stereo camera really measures (a disparity), so
/// its sigma does not depend on the distance: sigma(z) = sigma_inverse_depth * z^2. It takes the
/// place of the "virtual right coordinate" of ORB-SLAM2 without need of a made-up baseline.
struct PointMeasurement {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double inverse_depth = 0;         ///< 1/m; 0 = unknown
  double pixel_weight = 1;          ///< 1 / sigma of each pixel coordinate
  double inverse_depth_weight = 0;  ///< 1 / sigma of the inverse depth; 0 = unknown

  [[nodiscard]] bool has_depth() const { return inverse_depth_weight > 0; }
};

/// The 95 % bounds of chi-squared with 2 and 3 degrees of freedom.
inline constexpr double kChi2Bound2 = 5.991;
inline constexpr double kChi2Bound3 = 7.815;

[[nodiscard]] inline double chi2_bound(const PointMeasurement& m) {
  return m.has_depth() ? kChi2Bound3 : kChi2Bound2;
}

/// Predicted minus measured (u, v, 1/z), each divided by its sigma; the third is 0 without depth.
/// `p_camera.z()` is positive.
[[nodiscard]] inline Eigen::Vector3d reprojection_residual(const CameraModel& camera,
                                                           const PointMeasurement& m,
                                                           const Eigen::Vector3d& p_camera) {
  const double iz = 1.0 / p_camera.z();
  return {(camera.fx * p_camera.x() * iz + camera.cx - m.px.x()) * m.pixel_weight,
          (camera.fy * p_camera.y() * iz + camera.cy - m.px.y()) * m.pixel_weight,
          (iz - m.inverse_depth) * m.inverse_depth_weight};
}

/// Derivative of the residual by the point in camera coordinates.
[[nodiscard]] inline Eigen::Matrix3d reprojection_jacobian(const CameraModel& camera,
                                                           const PointMeasurement& m,
                                                           const Eigen::Vector3d& p_camera) {
  const double iz = 1.0 / p_camera.z();
  const double a = camera.fx * iz * m.pixel_weight, b = camera.fy * iz * m.pixel_weight;
  Eigen::Matrix3d J;
  J << a, 0, -a * p_camera.x() * iz,  //
      0, b, -b * p_camera.y() * iz,   //
      0, 0, -iz * iz * m.inverse_depth_weight;
  return J;
}

/// Derivative of the residual by a step of the pose (perturb_left on T_camera_world), given that by
/// the point in camera coordinates.
[[nodiscard]] inline Eigen::Matrix<double, 3, 6> pose_jacobian(const Eigen::Matrix3d& J_point,
                                                               const Eigen::Vector3d& p_camera) {
  Eigen::Matrix<double, 3, 6> J;
  J.leftCols<3>() = J_point;
  J.rightCols<3>() = -J_point * skew(p_camera);
  return J;
}

/// Huber's loss of a squared norm, and the weight that makes least squares follow it.
struct Huber {
  double cost;
  double weight = 1;

  Huber(double squared_norm, double bound_squared) : cost(squared_norm) {
    if (squared_norm <= bound_squared) return;
    const double norm = std::sqrt(squared_norm), bound = std::sqrt(bound_squared);
    cost = 2 * bound * norm - bound_squared;
    weight = bound / norm;
  }
};

/// Nearer points cannot be seen; the residual is undefined at zero depth.
inline constexpr double kMinPointDepth = 0.05;

/// The point is before the camera and its residual within the 95 % bound.
[[nodiscard]] inline bool agrees_with(const CameraModel& camera,
                                      const PointMeasurement& m,
                                      const Eigen::Vector3d& p_camera) {
  return p_camera.z() >= kMinPointDepth &&
         reprojection_residual(camera, m, p_camera).squaredNorm() <= chi2_bound(m);
}

}  // namespace stillmap
