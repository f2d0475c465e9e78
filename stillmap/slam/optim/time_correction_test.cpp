// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/time_correction.hpp"

#include <cmath>
#include <unordered_map>

#include <gtest/gtest.h>

#include "stillmap/slam/optim/measurement_model.hpp"
#include "stillmap/slam/optim/pose_time.hpp"
#include "tests/support/simulated_world.hpp"

namespace stillmap {
namespace {

constexpr CameraTimes kTrue{.readout_s = 0.02, .depth_delay_s = -0.012};
constexpr double kStep_s = 5e-3;

const SimulatedWorld& test_world() {
  static const SimulatedWorld world({}, simulated_camera());
  return world;
}

// To and fro, so that the velocity changes.
Eigen::Isometry3d swing(double time_s) {
  const double s = std::sin(4 * time_s);
  return make_pose(so3_exp(s * Eigen::Vector3d(0.02, -0.03, 0.08)),
                   s * Eigen::Vector3d(0.06, -0.04, 0.12));
}

CameraVelocity velocity_at(double time_s) {
  return mean_velocity(swing(time_s - 1e-4).inverse() * swing(time_s + 1e-4), 2e-4);
}

/// What the camera sees at a time, and its points by their number in the world.
class Seen {
 public:
  explicit Seen(double time_s) : time_s_(time_s) {
    std::mt19937 rng(1);
    Observed seen = test_world().observe_rolling(swing, time_s, kTrue.readout_s, {}, rng);
    points_ = seen.points;
    features_ = std::move(seen.features);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double row_s = row_position(features_.raw_px[i], test_world().camera());
      const double depth_s = time_s + row_s * kTrue.readout_s + kTrue.depth_delay_s;
      features_.sensor_depth_m[i] = static_cast<float>(
          (swing(depth_s).inverse() * test_world().points()[points_[i]].position).z());
    }
  }

  [[nodiscard]] FeatureTiming timing(const CameraTimes& assumed) const {
    const CameraVelocity velocity = velocity_at(time_s_);
    return {velocity, velocity, 0, assumed, PoseByTimes::Zero()};
  }

  [[nodiscard]] Features corrected(const CameraTimes& assumed) const {
    return at_pose_time(features_, test_world().camera(), timing(assumed));
  }

  /// The landmarks that a key frame here makes.
  [[nodiscard]] std::unordered_map<std::uint32_t, Eigen::Vector3d> landmarks(
      const CameraTimes& assumed) const {
    std::unordered_map<std::uint32_t, Eigen::Vector3d> result;
    const Features features = corrected(assumed);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      result[points_[i]] = swing(time_s_) * test_world().camera().unproject(
                                                features.px[i].cast<double>(),
                                                static_cast<double>(features.depth_m[i]));
    }
    return result;
  }

  /// The pose against landmarks, and how it follows the times.
  [[nodiscard]] std::pair<Eigen::Isometry3d, FeatureTiming> track(
      const std::unordered_map<std::uint32_t, Eigen::Vector3d>& landmarks,
      const CameraTimes& assumed) const {
    const Features features = corrected(assumed);
    // All observations are inliers, so that the optimum moves smoothly.
    const MeasurementModel measure({.pixel_sigma_px = 10, .inverse_depth_sigma = 0.1},
                                   test_world().level_scales());
    std::vector<PoseObservation> observations;
    std::vector<double> row;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto landmark = landmarks.find(points_[i]);
      if (landmark == landmarks.end()) continue;
      observations.push_back({landmark->second, measure(features, i), 1});
      row.push_back(row_position(features.raw_px[i], test_world().camera()));
    }
    const Eigen::Isometry3d T =
        optimize_pose(test_world().camera(), swing(time_s_).inverse(), observations).T_camera_world;
    FeatureTiming result = timing(assumed);
    result.pose_by_times = pose_by_times(test_world().camera(),
                                         T,
                                         observations,
                                         row,
                                         result.velocity,
                                         pose_information(test_world().camera(), T, observations));
    return {T, result};
  }

 private:
  double time_s_;
  std::vector<std::uint32_t> points_;
  Features features_;
};

std::unordered_map<std::uint32_t, Eigen::Vector3d> true_landmarks() {
  std::unordered_map<std::uint32_t, Eigen::Vector3d> result;
  for (std::uint32_t i = 0; i < test_world().points().size(); ++i) {
    result[i] = test_world().points()[i].position;
  }
  return result;
}

Vector6d step_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after) {
  Vector6d step;
  const Eigen::Isometry3d change = after * before.inverse();
  step << change.translation(), so3_log(Eigen::Quaterniond(change.linear()));
  return step;
}

TEST(PoseByTimes, IsTheDerivativeOfTheOptimalPose) {
  const Seen seen(0.1);
  const auto landmarks = true_landmarks();
  const PoseByTimes derivative = seen.track(landmarks, kTrue).second.pose_by_times;
  for (const int which : {0, 1}) {
    CameraTimes more = kTrue, less = kTrue;
    (which == 0 ? more.readout_s : more.depth_delay_s) += kStep_s;
    (which == 0 ? less.readout_s : less.depth_delay_s) -= kStep_s;
    const Vector6d numeric =
        step_between(seen.track(landmarks, less).first, seen.track(landmarks, more).first) /
        (2 * kStep_s);
    EXPECT_GT(numeric.norm(), 0.01);
    EXPECT_LT((derivative.col(which) - numeric).norm(), 0.03 * numeric.norm())
        << derivative.col(which).transpose() << "; " << numeric.transpose();
  }
}

TEST(TimeCorrection, MendsPosesMeasuredUnderWrongTimes) {
  const CameraTimes assumed;
  const Seen reference(0.0);
  const auto landmarks = reference.landmarks(assumed);
  const FeatureTiming of_reference = reference.track(landmarks, assumed).second;
  for (const double time_s : {0.4, 0.6}) {
    const auto [T_frame_world, timing] = Seen(time_s).track(landmarks, assumed);
    const Eigen::Isometry3d T_true = swing(time_s).inverse() * swing(0.0);
    const Eigen::Isometry3d T = T_frame_world * swing(0.0);
    const Eigen::Isometry3d T_corrected =
        perturb_left(T, time_correction(timing, of_reference, T).step(kTrue));
    const double wrong_m = step_between(T_true, T).head<3>().norm();
    const double left_m = step_between(T_true, T_corrected).head<3>().norm();
    EXPECT_GT(wrong_m, 0.003) << time_s;
    // Not all landmarks of the reference are in view here.
    EXPECT_LT(left_m, 0.5 * wrong_m) << time_s;
  }
}

TEST(TimeCorrection, IsNothingWhereTheTimesAreThoseAssumedOrMotionIsAlike) {
  const Seen seen(0.1);
  const FeatureTiming timing = seen.track(true_landmarks(), kTrue).second;
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_LT(time_correction(timing, {}, T).step(kTrue).norm(), 1e-12);
  EXPECT_GT(time_correction(timing, {}, T).step({}).norm(), 1e-4);
  EXPECT_LT(time_correction(timing, timing, T).step({}).norm(), 1e-12);
}

}  // namespace
}  // namespace stillmap
