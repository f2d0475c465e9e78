// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace stillmap {

// Free functions on Eigen::Isometry3d. A twist is (translation, rotation), the rotation an axis
// times an angle in radians. Signs follow Barfoot, "State Estimation for Robotics", ch. 7.

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The skew-symmetric matrix of v: its product with w is v x w.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The rotation by |w| about w.
[[nodiscard]] inline Eigen::Quaterniond so3_exp(const Eigen::Vector3d& w) {
  const double half = 0.5 * w.norm();
  const double scale = half < 1e-8 ? 0.5 - half * half / 12.0 : 0.5 * std::sin(half) / half;
  return Eigen::Quaterniond(std::cos(half), scale * w.x(), scale * w.y(), scale * w.z());
}

/// The inverse of so3_exp, with an angle in [0, pi].
[[nodiscard]] inline Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double s = v.norm();
  if (s < 1e-10) return 2.0 * v;
  return (2.0 * std::atan2(s, sign * q.w()) / s) * v;
}

[[nodiscard]] inline Eigen::Isometry3d make_pose(const Eigen::Quaterniond& q,
                                                 const Eigen::Vector3d& t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = t;
  return T;
}

/// A step from T on the manifold, in the camera frame: T_camera_world -> delta * T_camera_world
/// with delta = (exp(w), v). Translation and rotation change separately, which is cheaper than the
/// exponential of SE(3) and equal to it to first order.
[[nodiscard]] inline Eigen::Isometry3d perturb_left(const Eigen::Isometry3d& T,
                                                    const Vector6d& step) {
  const Eigen::Quaterniond dq = so3_exp(step.tail<3>());
  return make_pose(dq * Eigen::Quaterniond(T.linear()), dq * T.translation() + step.head<3>());
}

/// The angle of a rotation, radians, in [0, pi].
[[nodiscard]] inline double rotation_angle(const Eigen::Matrix3d& R) {
  return so3_log(Eigen::Quaterniond(R)).norm();
}

/// The pose interpolated between a (s = 0) and b (s = 1); s outside [0, 1] extrapolates.
[[nodiscard]] inline Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a,
                                                   const Eigen::Isometry3d& b,
                                                   double s) {
  const Eigen::Quaterniond qa(a.linear());
  const Eigen::Vector3d w = so3_log(qa.conjugate() * Eigen::Quaterniond(b.linear()));
  return make_pose(qa * so3_exp(s * w), (1.0 - s) * a.translation() + s * b.translation());
}

}  // namespace stillmap
