// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/camera_velocity.hpp"

#include "stillmap/geometry/se3.hpp"

namespace stillmap {

CameraVelocity mean_velocity(const Eigen::Isometry3d& T_before_after, double duration_s) {
  if (duration_s <= 0) return {};
  return {T_before_after.translation() / duration_s,
          so3_log(Eigen::Quaterniond(T_before_after.linear())) / duration_s};
}

CameraVelocity fitted_velocity(std::span<const TimedMotion> motions) {
  CameraVelocity sum;
  double mean_s = 0, squares = 0;
  for (const TimedMotion& m : motions) mean_s += m.time_s / static_cast<double>(motions.size());
  for (const TimedMotion& m : motions) {
    const double t = m.time_s - mean_s;
    squares += t * t;
    sum.linear += t * m.T_now_then.translation();
    sum.angular += t * so3_log(Eigen::Quaterniond(m.T_now_then.linear()));
  }
  if (squares <= 0) return {};
  return {sum.linear / squares, sum.angular / squares};
}

}  // namespace stillmap
