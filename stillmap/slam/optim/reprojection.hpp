// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {

/// A feature as a measurement of a point: its ideal pixel and, if known, its inverse depth.
///
/// A structured-light or stereo camera measures a disparity, which is proportional to the inverse
/// depth. The sigma of the inverse depth is therefore independent of distance: sigma(z) =
/// sigma_inverse_depth * z^2. The inverse depth replaces the "virtual right coordinate" of
/// ORB-SLAM2 without an invented baseline.
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
/// `p_camera.z()` must be positive.
[[nodiscard]] inline Eigen::Vector3d reprojection_residual(const CameraModel& camera,
                                                           const PointMeasurement& m,
                                                           const Eigen::Vector3d& p_camera) {
  const double iz = 1.0 / p_camera.z();
  return {(camera.fx * p_camera.x() * iz + camera.cx - m.px.x()) * m.pixel_weight,
          (camera.fy * p_camera.y() * iz + camera.cy - m.px.y()) * m.pixel_weight,
          (iz - m.inverse_depth) * m.inverse_depth_weight};
}

/// The derivative of the residual with respect to the point in camera coordinates.
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

/// The derivative of the residual with respect to a step of the pose (perturb_left on
/// T_camera_world), from that with respect to the point in camera coordinates.
[[nodiscard]] inline Eigen::Matrix<double, 3, 6> pose_jacobian(const Eigen::Matrix3d& J_point,
                                                               const Eigen::Vector3d& p_camera) {
  Eigen::Matrix<double, 3, 6> J;
  J.leftCols<3>() = J_point;
  J.rightCols<3>() = -J_point * skew(p_camera);
  return J;
}

/// The normal equations of one measurement, J^T w J and J^T w r, for the point in camera
/// coordinates.
struct PointEquations {
  Eigen::Matrix3d H;
  Eigen::Vector3d g;
};

[[nodiscard]] inline PointEquations point_equations(const CameraModel& camera,
                                                    const PointMeasurement& m,
                                                    const Eigen::Vector3d& p_camera,
                                                    const Eigen::Vector3d& residual,
                                                    double weight) {
  const Eigen::Matrix3d J = reprojection_jacobian(camera, m, p_camera);  // upper triangular
  const double a = weight * J(0, 0), b = weight * J(1, 1);
  const double c = weight * J(0, 2), d = weight * J(1, 2), e = weight * J(2, 2);
  PointEquations eq;
  eq.H << a * J(0, 0), 0, a * J(0, 2),  //
      0, b * J(1, 1), b * J(1, 2),      //
      a * J(0, 2), b * J(1, 2), c * J(0, 2) + d * J(1, 2) + e * J(2, 2);
  eq.g << a * residual.x(), b * residual.y(),
      c * residual.x() + d * residual.y() + e * residual.z();
  return eq;
}

/// [p]x M: the cross product of p with each column, without the zeros of the matrix [p]x.
[[nodiscard]] inline Eigen::Matrix3d cross_columns(const Eigen::Vector3d& p,
                                                   const Eigen::Matrix3d& M) {
  Eigen::Matrix3d result;
  result.row(0) = p.y() * M.row(2) - p.z() * M.row(1);
  result.row(1) = p.z() * M.row(0) - p.x() * M.row(2);
  result.row(2) = p.x() * M.row(1) - p.y() * M.row(0);
  return result;
}

/// Adds the normal equations to those of the pose; `H` gets the lower triangle. With J_pose = J [I
/// | -[p]x] the equations of the pose follow from those of the point in a third of the
/// multiplications.
inline void add_to_pose(const PointEquations& eq,
                        const Eigen::Vector3d& p_camera,
                        Matrix6d& H,
                        Vector6d& g) {
  const Eigen::Matrix3d turned = cross_columns(p_camera, eq.H);
  H.topLeftCorner<3, 3>() += eq.H;
  H.bottomLeftCorner<3, 3>() += turned;
  H.bottomRightCorner<3, 3>() += cross_columns(p_camera, turned.transpose());
  g.head<3>() += eq.g;
  g.tail<3>() += p_camera.cross(eq.g);
}

/// The Huber loss of a squared norm, and its weight for iteratively reweighted least squares.
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

/// The least depth of a visible point. The residual is undefined at zero depth.
inline constexpr double kMinPointDepth = 0.05;

/// Whether the point is in front of the camera and its residual within the 95 % bound.
[[nodiscard]] inline bool agrees_with(const CameraModel& camera,
                                      const PointMeasurement& m,
                                      const Eigen::Vector3d& p_camera) {
  return p_camera.z() >= kMinPointDepth &&
         reprojection_residual(camera, m, p_camera).squaredNorm() <= chi2_bound(m);
}

}  // namespace stillmap
