// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/rolling_shutter.hpp"

#include <algorithm>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/optim/symmetric_solver.hpp"

namespace stillmap {
namespace {

// What is known before the first frame: within 10 ms of the camera's stated readout.
constexpr double kPriorSigma = 0.01;

// A frame that could not tell the readout this well by itself has moved too little to count.
constexpr double kUsefulSigma_s = 0.02;

}  // namespace

Eigen::Vector3d CameraVelocity::of_point(const Eigen::Vector3d& p_camera) const {
  return -(angular.cross(p_camera) + linear);
}

CameraVelocity mean_velocity(const Eigen::Isometry3d& T_before_after, double duration_s) {
  if (duration_s <= 0) return {};
  return {T_before_after.translation() / duration_s,
          so3_log(Eigen::Quaterniond(T_before_after.linear())) / duration_s};
}

Features undo_rolling_shutter(Features features,
                              const CameraModel& camera,
                              double readout_s,
                              const CameraVelocity& velocity) {
  const CameraVelocity turn{Eigen::Vector3d::Zero(), velocity.angular};
  for (std::size_t i = 0; i < features.size(); ++i) {
    const double row = static_cast<double>(features.raw_px[i].y()) / camera.height_px - 0.5;
    const bool known = features.sensor_depth_m[i] > 0;
    const double depth = known ? static_cast<double>(features.sensor_depth_m[i]) : 1.0;
    const Eigen::Vector3d p = camera.unproject(features.ideal_px[i].cast<double>(), depth);
    const Eigen::Vector3d p_middle = p - row * readout_s * (known ? velocity : turn).of_point(p);
    if (p_middle.z() < kMinPointDepth) continue;
    features.px[i] = camera.project(p_middle).cast<float>();
    features.depth_m[i] = known ? static_cast<float>(p_middle.z()) : 0.0F;
  }
  features.grid = FeatureGrid(features.px, camera.width_px, camera.height_px);
  return features;
}

ReadoutEstimator::ReadoutEstimator(const ShutterConfig& config, const CameraModel& camera)
    : config_(config),
      camera_(camera),
      estimate_s_(std::min(camera.readout_s, config.max_readout_s)),
      information_(1.0 / (kPriorSigma * kPriorSigma)) {}

void ReadoutEstimator::update(const Eigen::Isometry3d& T_camera_world,
                              const CameraVelocity& velocity,
                              std::span<const PoseObservation> observations,
                              std::span<const double> rows) {
  if (!config_.calibrate) return;
  // Least squares in the pose and the readout, over residuals that end up as r + J [pose; readout]:
  // correcting for a longer readout moves the measurement by -row * velocity.
  Matrix6d H = Matrix6d::Zero();
  Vector6d cross = Vector6d::Zero(), g = Vector6d::Zero();
  double information = 0, gradient = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const PointMeasurement& m = observations[i].measurement;
    // Without depth a feature is only turned back, so what is left of its error is no error of the
    // readout alone.
    if (!m.has_depth()) continue;
    const Eigen::Vector3d p = T_camera_world * observations[i].p_world;
    const Eigen::Vector3d r = reprojection_residual(camera_, m, p);
    const Eigen::Matrix3d J_point = reprojection_jacobian(camera_, m, p);
    const Eigen::Matrix<double, 3, 6> J_pose = pose_jacobian(J_point, p);
    const Eigen::Vector3d j = rows[i] * (J_point * velocity.of_point(p));
    H.noalias() += J_pose.transpose() * J_pose;
    g.noalias() += J_pose.transpose() * r;
    cross.noalias() += J_pose.transpose() * j;
    information += j.squaredNorm();
    gradient += j.dot(r);
  }
  H.diagonal().array() += 1e-9;
  const Vector6d eliminated = solve_symmetric(H, cross);
  information -= cross.dot(eliminated);
  gradient -= g.dot(eliminated);
  // What was learnt in motion is not forgotten while the camera stands: the little "motion" that
  // noise makes there tells nothing and would pull the estimate to zero.
  if (!(information * kUsefulSigma_s * kUsefulSigma_s > 1)) return;
  // The residuals belong to the readout that was corrected with; the estimate may differ from it.
  gradient += information * (estimate_s_ - readout_s());
  information_ = config_.memory * information_ + information;
  estimate_s_ = std::clamp(estimate_s_ - gradient / information_, 0.0, config_.max_readout_s);
}

}  // namespace stillmap
