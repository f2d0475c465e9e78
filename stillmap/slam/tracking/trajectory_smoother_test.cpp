// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/trajectory_smoother.hpp"

#include <random>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr double kRate = 30.0;

// A hand that waves a camera about.
Eigen::Isometry3d waving(double t) {
  return make_pose(
      so3_exp(Eigen::Vector3d(0.3 * std::sin(1.7 * t), 0.5 * std::sin(1.3 * t), 0.2 * t)),
      Eigen::Vector3d(0.4 * std::sin(2.1 * t), 0.2 * std::sin(1.1 * t), 0.3 * std::cos(1.6 * t)));
}

struct Noise {
  double position_m = 0.003;
  double rotation_rad = 0.002;
};

// As tracking would measure it: noise in the camera's axes, with its information.
MeasuredPose measure(const Eigen::Isometry3d& T_world_camera,
                     double stamp_s,
                     const Noise& noise,
                     std::mt19937& rng) {
  std::normal_distribution<double> normal;
  Vector6d step;
  for (int k = 0; k < 6; ++k) {
    step[k] = (k < 3 ? noise.position_m : noise.rotation_rad) * normal(rng);
  }
  MeasuredPose pose{stamp_s, perturb_left(T_world_camera.inverse(), step).inverse()};
  for (int k = 0; k < 6; ++k) {
    const double sigma = std::max(k < 3 ? noise.position_m : noise.rotation_rad, 1e-6);
    pose.information(k, k) = 1 / (sigma * sigma);
  }
  return pose;
}

std::vector<MeasuredPose> walk(int frames, const Noise& noise, std::uint32_t seed = 1) {
  std::mt19937 rng(seed);
  std::vector<MeasuredPose> measured;
  for (int k = 0; k < frames; ++k) {
    const double jitter_s = 0.004 * (k % 3);  // as stamps of a Kinect have it
    const double t = k / kRate + jitter_s;
    measured.push_back(measure(waving(t), t, noise, rng));
  }
  return measured;
}

struct Error {
  double position_m = 0;  // root mean square
  double rotation_rad = 0;
};

Error error_of(const std::vector<MeasuredPose>& at, const std::vector<Eigen::Isometry3d>& poses) {
  Error error;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Eigen::Isometry3d truth = waving(at[i].stamp_s);
    error.position_m += (poses[i].translation() - truth.translation()).squaredNorm();
    const double angle =
        rotation_angle(Eigen::Matrix3d(truth.linear().transpose() * poses[i].linear()));
    error.rotation_rad += angle * angle;
  }
  const auto n = static_cast<double>(at.size());
  return {std::sqrt(error.position_m / n), std::sqrt(error.rotation_rad / n)};
}

std::vector<Eigen::Isometry3d> unchanged(const std::vector<MeasuredPose>& measured) {
  std::vector<Eigen::Isometry3d> poses;
  for (const MeasuredPose& pose : measured) poses.push_back(pose.T_world_camera);
  return poses;
}

TEST(SmoothTrajectory, TakesNoiseOffAMovingCamera) {
  const std::vector<MeasuredPose> measured = walk(300, {});
  const Error before = error_of(measured, unchanged(measured));
  const Error after = error_of(measured, smooth_trajectory(measured));
  EXPECT_LT(after.position_m, 0.65 * before.position_m);
  EXPECT_LT(after.rotation_rad, 0.65 * before.rotation_rad);
}

TEST(SmoothTrajectory, DoesNotDependOnTheScaleOfTheInformation) {
  std::vector<MeasuredPose> measured = walk(200, {});
  const std::vector<Eigen::Isometry3d> plain = smooth_trajectory(measured);
  for (MeasuredPose& pose : measured) pose.information *= 40;
  const std::vector<Eigen::Isometry3d> scaled = smooth_trajectory(measured);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_LT((plain[i].translation() - scaled[i].translation()).norm(), 4e-4);
  }
}

TEST(SmoothTrajectory, LeavesExactPosesAlone) {
  const std::vector<MeasuredPose> measured = walk(200, {0, 0});
  const Error after = error_of(measured, smooth_trajectory(measured));
  EXPECT_LT(after.position_m, 1e-4);
  EXPECT_LT(after.rotation_rad, 1e-4);
}

// A camera that jumps from frame to frame has no velocity to go by.
// The first frame defines the axes. The others join it there, and not where its features alone
// would put it.
TEST(SmoothTrajectory, KeepsThePoseThatDefinesTheAxes) {
  std::vector<MeasuredPose> measured = walk(200, {});
  measured[0].T_world_camera = waving(measured[0].stamp_s);
  measured[0].is_exact = true;
  const std::vector<Eigen::Isometry3d> smooth = smooth_trajectory(measured);
  EXPECT_EQ(smooth[0].matrix(), measured[0].T_world_camera.matrix());
  const auto error_m = [&](const Eigen::Isometry3d& T) {
    return (T.translation() - waving(measured[1].stamp_s).translation()).norm();
  };
  EXPECT_LT(error_m(smooth[1]), error_m(measured[1].T_world_camera));
  measured[0].is_exact = false;
  EXPECT_LT(error_m(smooth[1]), error_m(smooth_trajectory(measured)[1]));
}

TEST(SmoothTrajectory, LeavesAJerkyCameraNearlyAlone) {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  std::vector<MeasuredPose> measured;
  std::vector<Eigen::Vector3d> truth;
  double noise_m = 0, error_m = 0;
  for (int k = 0; k < 200; ++k) {
    truth.emplace_back(0.1 * normal(rng), 0.1 * normal(rng), 0.1 * normal(rng));
    const Eigen::Isometry3d T =
        make_pose(so3_exp(0.1 * Eigen::Vector3d(normal(rng), normal(rng), normal(rng))), truth[k]);
    measured.push_back(measure(T, k / kRate, {}, rng));
  }
  const std::vector<Eigen::Isometry3d> smooth = smooth_trajectory(measured);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    noise_m += (measured[k].T_world_camera.translation() - truth[k]).squaredNorm();
    error_m += (smooth[k].translation() - truth[k]).squaredNorm();
  }
  EXPECT_LT(std::sqrt(error_m), 1.5 * std::sqrt(noise_m));
}

TEST(SmoothTrajectory, BelievesAFrameByItsInformation) {
  std::vector<MeasuredPose> measured = walk(200, {});
  std::mt19937 rng(8);
  // Every tenth frame saw little.
  for (std::size_t i = 5; i < measured.size(); i += 10) {
    measured[i] = measure(waving(measured[i].stamp_s), measured[i].stamp_s, {0.05, 0.03}, rng);
  }
  const std::vector<Eigen::Isometry3d> smooth = smooth_trajectory(measured);
  for (std::size_t i = 5; i < measured.size(); i += 10) {
    EXPECT_LT((smooth[i].translation() - waving(measured[i].stamp_s).translation()).norm(), 0.015);
  }
}

TEST(SmoothTrajectory, LeavesAFewPosesAlone) {
  const std::vector<MeasuredPose> measured = walk(10, {});
  const std::vector<Eigen::Isometry3d> smooth = smooth_trajectory(measured);
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    EXPECT_EQ(smooth[i].matrix(), measured[i].T_world_camera.matrix());
  }
  EXPECT_TRUE(smooth_trajectory({}).empty());
}

TEST(SmoothTrajectory, SmoothsLongTrajectoriesInParts) {
  const std::vector<MeasuredPose> measured = walk(2010, {});
  const Error before = error_of(measured, unchanged(measured));
  const Error after = error_of(measured, smooth_trajectory(measured));
  EXPECT_LT(after.position_m, 0.65 * before.position_m);
}

}  // namespace
}  // namespace stillmap
