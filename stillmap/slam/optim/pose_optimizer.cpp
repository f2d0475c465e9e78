// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/pose_optimizer.hpp"

#include <cmath>
#include <limits>

#include "stillmap/slam/optim/symmetric_solver.hpp"

namespace stillmap {
namespace {

constexpr int kRounds = 4;
constexpr int kRobustRounds = 2;
constexpr int kIterations = 8;
constexpr int kMinObservations = 3;
constexpr double kPoseConverged = 1e-6;  // relative decrease of the cost

using Observations = std::span<const PoseObservation>;

double squared_error(const CameraModel& camera,
                     const Eigen::Isometry3d& T,
                     const PoseObservation& observation) {
  const Eigen::Vector3d p_camera = T * observation.p_world;
  if (p_camera.z() < kMinPointDepth) return std::numeric_limits<double>::infinity();
  return reprojection_residual(camera, observation.measurement, p_camera).squaredNorm();
}

double loss(double chi2, const PointMeasurement& measurement, bool robust) {
  return robust ? Huber(chi2, chi2_bound(measurement)).cost : chi2;
}

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();  // the lower triangle
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

NormalEquations linearize(const CameraModel& camera,
                          const Eigen::Isometry3d& T,
                          Observations observations,
                          std::span<const std::uint8_t> inlier,
                          bool robust) {
  NormalEquations eq;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (inlier[i] == 0) continue;
    const PointMeasurement& m = observations[i].measurement;
    const Eigen::Vector3d p_camera = T * observations[i].p_world;
    if (p_camera.z() < kMinPointDepth) continue;
    const Eigen::Vector3d r = reprojection_residual(camera, m, p_camera);
    const Huber huber(r.squaredNorm(), chi2_bound(m));
    const double trust = observations[i].trust;
    const double weight = trust * (robust ? huber.weight : 1.0);
    add_to_pose(point_equations(camera, m, p_camera, r, weight), p_camera, eq.H, eq.g);
    eq.cost += trust * (robust ? huber.cost : r.squaredNorm());
  }
  return eq;
}

double total_cost(const CameraModel& camera,
                  const Eigen::Isometry3d& T,
                  Observations observations,
                  std::span<const std::uint8_t> inlier,
                  bool robust) {
  double cost = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (inlier[i] == 0) continue;
    const PoseObservation& o = observations[i];
    cost += o.trust * loss(squared_error(camera, T, o), o.measurement, robust);
  }
  return cost;
}

Eigen::Isometry3d minimize(const CameraModel& camera,
                           Eigen::Isometry3d T,
                           Observations observations,
                           std::span<const std::uint8_t> inlier,
                           bool robust) {
  double damping = 1e-5;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const NormalEquations eq = linearize(camera, T, observations, inlier, robust);
    Matrix6d H = eq.H;
    H.diagonal() += damping * eq.H.diagonal();
    H.diagonal().array() += 1e-9;  // keeps an undetermined direction where it is
    const Vector6d step = solve_symmetric(H, -eq.g);
    if (!step.allFinite()) break;
    const Eigen::Isometry3d candidate = perturb_left(T, step);
    const double cost = total_cost(camera, candidate, observations, inlier, robust);
    if (!(cost <= eq.cost)) {  // also when not a number
      damping *= 100;
      continue;
    }
    T = candidate;
    damping = std::max(damping * 0.1, 1e-9);
    if (eq.cost - cost < kPoseConverged * eq.cost) break;
  }
  return T;
}

}  // namespace

PoseEstimate optimize_pose(const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_world,
                           Observations observations) {
  PoseEstimate estimate{T_camera_world, std::vector<std::uint8_t>(observations.size(), 0), 0};
  // A point behind the camera would make every step's cost infinite, and one that is no number
  // would make the step none: they stay out until a later round finds them within the bound.
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const bool usable = std::isfinite(squared_error(camera, T_camera_world, observations[i]));
    estimate.inlier[i] = usable ? 1 : 0;
    estimate.inliers += estimate.inlier[i];
  }
  if (estimate.inliers < kMinObservations) {
    return {T_camera_world, std::vector<std::uint8_t>(observations.size(), 0), 0};
  }
  for (int round = 0; round < kRounds && estimate.inliers >= kMinObservations; ++round) {
    estimate.T_camera_world = minimize(
        camera, estimate.T_camera_world, observations, estimate.inlier, round < kRobustRounds);
    estimate.inliers = 0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      const double chi2 = squared_error(camera, estimate.T_camera_world, observations[i]);
      estimate.inlier[i] = chi2 <= chi2_bound(observations[i].measurement) ? 1 : 0;
      estimate.inliers += estimate.inlier[i];
    }
  }
  return estimate;
}

Matrix6d pose_information(const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_world,
                          Observations observations) {
  const std::vector<std::uint8_t> all(observations.size(), 1);
  const Matrix6d H = linearize(camera, T_camera_world, observations, all, false).H;
  return H.selfadjointView<Eigen::Lower>();
}

}  // namespace stillmap
