// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

struct BundleConfig {
  int robust_iterations = 5;
  int final_iterations = 5;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("robust_iterations",
          self.robust_iterations,
          FieldInfo{"number of iterations with outliers, under a robust loss", "", 0, 100});
    visit("final_iterations",
          self.final_iterations,
          FieldInfo{"number of iterations without outliers", "", 0, 100});
  }
};

struct BundleObservation {
  std::uint32_t camera = 0;
  std::uint32_t point = 0;
  PointMeasurement measurement;
};

/// The input: camera poses, some of which are held, points, and observations. Observations are
/// grouped by point (all of point 0, then of point 1, ...).
struct BundleProblem {
  CameraModel camera;
  std::vector<Eigen::Isometry3d> T_camera_world;
  std::vector<std::uint8_t> held;  ///< per camera
  std::vector<Eigen::Vector3d> points;
  std::vector<BundleObservation> observations;
};

struct BundleResult {
  std::vector<Eigen::Isometry3d> T_camera_world;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint8_t> inlier;  ///< per observation: within the 95 % bound at the end
  double initial_cost = 0;           ///< Huber loss of all points in front of their cameras, before
  double final_cost = 0;             ///< Huber loss of the same points, after
  int iterations = 0;
};

/// Bundle adjustment: minimises the Huber loss of all reprojection errors over the free poses and
/// all points, by Levenberg-Marquardt on the Schur complement, which is dense over the cameras and
/// suits windows of up to about 50. First with all observations, then with those inside the 95 %
/// bound. Single-threaded and without time limits, so that equal input gives equal bits.
[[nodiscard]] BundleResult adjust_bundle(BundleProblem problem, const BundleConfig& config);

}  // namespace stillmap
