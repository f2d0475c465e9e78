// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/time_evidence.hpp"

#include <cmath>
#include <map>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "stillmap/slam/optim/measurement_model.hpp"
#include "stillmap/slam/optim/pose_time.hpp"
#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/simulated_world.hpp"

namespace stillmap {
namespace {

const SimulatedWorld& small_world() {
  static const SimulatedWorld world({.points = 300}, simulated_camera());
  return world;
}

const SimulatedWorld& large_world() {
  static const SimulatedWorld world({.points = 5000}, simulated_camera());
  return world;
}

MeasurementModel model() {
  return MeasurementModel({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                          small_world().level_scales());
}

CameraVelocity velocity_at(const CameraPath& path, double t) {
  constexpr double kHalf_s = 1e-3;
  return mean_velocity(path(t - kHalf_s).inverse() * path(t + kHalf_s), 2 * kHalf_s);
}

constexpr ObservationNoise kNoise{.pixel_sigma_px = 0.3, .missing_depth_share = 0.2};
constexpr ObservationNoise kExactDepth{.pixel_sigma_px = 0.5};

/// Frames of a moving camera, each feature with its point.
struct Recording {
  const SimulatedWorld& world;
  std::vector<Eigen::Isometry3d> T_camera_world;
  std::vector<Features> features;
  std::vector<std::vector<std::uint32_t>> points;
  std::vector<FeatureTiming> timing;
};

Recording record(const SimulatedWorld& world,
                 const CameraPath& path,
                 const CameraTimes& truth,
                 int frames,
                 const ObservationNoise& noise) {
  Recording recording{world, {}, {}, {}, {}};
  std::mt19937 rng(5);
  for (int k = 0; k < frames; ++k) {
    const double t = 0.3 * k;
    Observed seen = world.observe_rolling(path, t, truth.readout_s, noise, rng);
    const double after_s = truth.depth_delay_s;
    for (std::size_t i = 0; i < seen.features.size(); ++i) {
      if (seen.features.sensor_depth_m[i] <= 0) continue;
      const Eigen::Vector3d& p = world.points()[seen.points[i]].position;
      const double row = row_position(seen.features.raw_px[i], world.camera());
      const double later_s = t + after_s + row * truth.readout_s;
      seen.features.sensor_depth_m[i] = static_cast<float>((path(later_s).inverse() * p).z());
    }
    const CameraVelocity velocity = velocity_at(path, t);
    recording.T_camera_world.push_back(path(t).inverse());
    recording.features.push_back(std::move(seen.features));
    recording.points.push_back(std::move(seen.points));
    recording.timing.push_back({velocity, velocity, 0, {}});
  }
  return recording;
}

/// The bundle with features corrected for `times`.
TimedBundle bundle_of(const Recording& recording, const CameraTimes& times) {
  TimedBundle bundle;
  BundleProblem& problem = bundle.problem;
  problem.camera = recording.world.camera();
  problem.T_camera_world = recording.T_camera_world;
  problem.held.assign(recording.features.size(), 0);
  bundle.timing = recording.timing;
  for (FeatureTiming& timing : bundle.timing) timing.assumed = times;
  std::vector<Features> corrected;
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> seen;
  for (std::uint32_t c = 0; c < recording.features.size(); ++c) {
    corrected.push_back(at_pose_time(recording.features[c], problem.camera, bundle.timing[c]));
    for (std::uint32_t i = 0; i < recording.points[c].size(); ++i) {
      seen[recording.points[c][i]].emplace_back(c, i);
    }
  }
  for (const auto& [world_point, places] : seen) {
    const auto point = static_cast<std::uint32_t>(problem.points.size());
    problem.points.push_back(recording.world.points()[world_point].position);
    for (const auto& [c, i] : places) {
      problem.observations.push_back({c, point, model()(corrected[c], i)});
      bundle.row.push_back(row_position(corrected[c].raw_px[i], problem.camera));
    }
  }
  return bundle;
}

// Features are single-precision numbers: a step of both times must be large beside their errors.
constexpr double kTimeUnit_s = 100;

// All residuals as a function of both times, in their unit, the steps of all poses and of all
// points.
Eigen::VectorXd residuals(const Recording& recording, const Eigen::VectorXd& x) {
  const TimedBundle bundle = bundle_of(recording, {kTimeUnit_s * x[0], kTimeUnit_s * x[1]});
  const BundleProblem& problem = bundle.problem;
  const auto cameras = static_cast<Eigen::Index>(problem.T_camera_world.size());
  Eigen::VectorXd r(3 * static_cast<Eigen::Index>(problem.observations.size()));
  Eigen::Index at = 0;
  for (const BundleObservation& o : problem.observations) {
    const Eigen::Isometry3d T =
        perturb_left(problem.T_camera_world[o.camera], x.segment<6>(2 + 6 * o.camera));
    const Eigen::Vector3d p = problem.points[o.point] + x.segment<3>(2 + 6 * cameras + 3 * o.point);
    r.segment<3>(at) = reprojection_residual(problem.camera, o.measurement, T * p);
    at += 3;
  }
  return r;
}

TEST(TimeEvidence, IsWhatTheDenseNormalEquationsLeave) {
  const Recording recording = record(
      small_world(), [](double t) { return swinging(t); }, {0.02, 0.01}, 3, kExactDepth);
  const CameraTimes assumed{0.004, -0.003};
  const TimedBundle bundle = bundle_of(recording, assumed);
  const Eigen::Index size = 2 + 6 * 3 + 3 * std::ssize(bundle.problem.points);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  x[0] = assumed.readout_s / kTimeUnit_s;
  x[1] = assumed.depth_delay_s / kTimeUnit_s;
  const auto f = [&](const Eigen::VectorXd& at) { return residuals(recording, at); };
  Eigen::MatrixXd J = numeric_jacobian(f, x, 1e-5);
  J.leftCols<2>() /= kTimeUnit_s;
  Eigen::MatrixXd H = J.transpose() * J;
  H.diagonal().tail(size - 2).array() += 1e-3;  // the prior that keeps H regular
  const Eigen::VectorXd step = H.ldlt().solve(-J.transpose() * f(x));
  const Eigen::Matrix2d covariance = H.inverse().topLeftCorner<2, 2>();

  const TimeEvidence evidence = time_evidence(bundle);
  const Eigen::Vector2d times = evidence.information.inverse() * evidence.vector;
  EXPECT_NEAR(times[0], assumed.readout_s + step[0], 0.03 * std::sqrt(covariance(0, 0)));
  EXPECT_NEAR(times[1], assumed.depth_delay_s + step[1], 0.03 * std::sqrt(covariance(1, 1)));
  const Eigen::Matrix2d own = evidence.information.inverse();
  EXPECT_LT((own - covariance).norm(), 0.03 * covariance.norm());
}

TEST(TimeEvidence, FindsTheTimesWhateverIsAssumed) {
  const CameraTimes truth{0.02, -0.015};
  const Recording recording = record(
      large_world(), [](double t) { return swinging(t); }, truth, 12, kNoise);
  for (const CameraTimes& assumed : {CameraTimes{}, CameraTimes{0.03, 0.02}}) {
    const TimeEvidence evidence = time_evidence(bundle_of(recording, assumed));
    const Eigen::Matrix2d covariance = evidence.information.inverse();
    const Eigen::Vector2d times = covariance * evidence.vector;
    EXPECT_LT(std::sqrt(covariance(0, 0)), 1e-3);
    EXPECT_LT(std::sqrt(covariance(1, 1)), 5e-3);
    EXPECT_NEAR(times[0], truth.readout_s, 2e-3);
    EXPECT_NEAR(times[1], truth.depth_delay_s, 4e-3);
  }
}

TEST(TimeEvidence, SteadyMotionTellsAlmostNothing) {
  const auto information = [](const CameraPath& path) {
    return time_evidence(bundle_of(record(small_world(), path, {0.02, 0}, 6, kNoise), {}))
        .information(0, 0);
  };
  const double steady = information([](double t) {
    return make_pose(Eigen::Quaterniond::Identity(), {0.3 * t - 0.3, 0, 0});
  });
  const double back_and_forth = information([](double t) {
    return make_pose(Eigen::Quaterniond::Identity(), {0.25 * std::sin(1.2 * t), 0, 0});
  });
  EXPECT_LT(steady, 0.05 * back_and_forth);
}

TEST(TimeEvidence, HeldCamerasTakeNoPart) {
  const Recording recording = record(
      small_world(), [](double t) { return swinging(t); }, {0.02, 0}, 4, kNoise);
  TimedBundle bundle = bundle_of(recording, {});
  bundle.problem.held.assign(4, 1);
  EXPECT_EQ(time_evidence(bundle).information.norm(), 0);
}

}  // namespace
}  // namespace stillmap
