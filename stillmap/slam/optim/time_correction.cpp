// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/time_correction.hpp"

#include <Eigen/Cholesky>

#include "stillmap/slam/optim/pose_time.hpp"
#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {
namespace {

Eigen::Vector2d vector_of(const CameraTimes& times) {
  return {times.readout_s, times.depth_delay_s};
}

// The step of T_a_c that does the same as the step of T_b_c, for c at rest.
Matrix6d step_in_frame(const Eigen::Isometry3d& T_a_b) {
  Matrix6d result = Matrix6d::Zero();
  result.topLeftCorner<3, 3>() = T_a_b.linear();
  result.bottomRightCorner<3, 3>() = T_a_b.linear();
  result.topRightCorner<3, 3>() = skew(T_a_b.translation()) * T_a_b.linear();
  return result;
}

}  // namespace

PoseByTimes pose_by_times(const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_world,
                          std::span<const PoseObservation> observations,
                          std::span<const double> row,
                          const CameraVelocity& velocity,
                          const Matrix6d& information) {
  PoseByTimes g = PoseByTimes::Zero();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const PointMeasurement& m = observations[i].measurement;
    const Eigen::Vector3d p = T_camera_world * observations[i].p_world;
    if (p.z() < kMinPointDepth) continue;
    const Eigen::Matrix3d J = reprojection_jacobian(camera, m, p);
    const Eigen::Vector3d motion = J * corrected_velocity(velocity, m.has_depth()).of_point(p);
    g.noalias() +=
        observations[i].trust * pose_jacobian(J, p).transpose() * residual_by_times(motion, row[i]);
  }
  return -information.ldlt().solve(g);
}

Vector6d TimeCorrection::step(const CameraTimes& times) const {
  return by_times * vector_of(times) + without_times;
}

TimeCorrection time_correction(const FeatureTiming& frame,
                               const FeatureTiming& reference,
                               const Eigen::Isometry3d& T_frame_reference) {
  const PoseByTimes of_reference = step_in_frame(T_frame_reference) * reference.pose_by_times;
  return {
      frame.pose_by_times - of_reference,
      of_reference * vector_of(reference.assumed) - frame.pose_by_times * vector_of(frame.assumed)};
}

}  // namespace stillmap
