// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/smoothing_stage.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "stillmap/concurrency/worker.hpp"
#include "stillmap/session/session_map.hpp"
#include "stillmap/slam/tracking/trajectory_smoother.hpp"

namespace stillmap {
namespace {

/// A session with one key frame, off the origin.
Session session_of_one_keyframe() {
  Session session{builtin_camera("tum_fr3"), {}, Map({1.0F}), {}, {}, {}};
  Keyframe keyframe;
  keyframe.submap = SubmapId(0);
  keyframe.T_world_camera = make_pose(so3_exp({0.1, 0.2, 0.3}), {1, 2, 3});
  keyframe.features = std::make_shared<const Features>();
  (void)session.map.add_keyframe(std::move(keyframe));
  return session;
}

/// A camera on a smooth way, measured with a noise of 5 mm and 5 mrad, which its information tells.
class Walk {
 public:
  MeasuredPose next() {
    const double t = count_++ / 30.0;
    const auto noise = [this] {
      return Eigen::Vector3d(0.005 * normal_(rng_), 0.005 * normal_(rng_), 0.005 * normal_(rng_));
    };
    MeasuredPose pose;
    pose.stamp_s = t;
    pose.T_world_camera = make_pose(so3_exp(Eigen::Vector3d(0.1 * std::sin(t), 0.2, 0) + noise()),
                                    Eigen::Vector3d(std::sin(t), std::cos(t), 0.1) + noise());
    pose.information = Matrix6d::Identity() / (0.005 * 0.005);
    return pose;
  }

 private:
  std::mt19937 rng_{7};
  std::normal_distribution<double> normal_;
  int count_ = 0;
};

void run(Worker* worker) {
  constexpr std::size_t kFrames = 4300, kMost = 500;
  Session session = session_of_one_keyframe();
  const Eigen::Isometry3d T_keyframe_world = session.map.T_world_keyframe(KeyframeId(0)).inverse();
  SmoothingStage stage(true, {worker, {}}, kMost);
  Walk walk;
  std::vector<MeasuredPose> measured;
  for (std::size_t i = 0; i < kFrames; ++i) {
    measured.push_back(walk.next());
    session.frames.push_back({{measured.back().stamp_s, {}},
                              KeyframeId(0),
                              T_keyframe_world * measured.back().T_world_camera});
    stage.add({measured.back().information, {}});
    stage.process(session, {}, static_cast<std::int64_t>(i));
    ASSERT_LE(stage.waiting(), kMost + 1000) << "what is kept does not grow";
  }
  stage.finish(session, {});
  EXPECT_EQ(stage.waiting(), 0U);
  // The map has not changed meanwhile, so poses are those of a trajectory smoothed as a whole.
  const std::vector<Eigen::Isometry3d> expected = smooth_trajectory(measured);
  double moved_m = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const Eigen::Isometry3d T = T_world_frame(session, session.frames[i]);
    ASSERT_TRUE(T.isApprox(expected[i], 1e-9)) << i;
    moved_m += (T.translation() - measured[i].T_world_camera.translation()).norm() / kFrames;
  }
  EXPECT_GT(moved_m, 0.002) << "poses are smoothed at all";
}

TEST(SmoothingStage, SmoothsEarlyPosesWhileTheRunGoesOn) {
  run(nullptr);
}

TEST(SmoothingStage, SmoothsThemBesideTheRun) {
  Worker worker;
  run(&worker);
}

void correct_times(std::size_t frames, const SmoothingStage& empty) {
  constexpr CameraTimes kTrue{.readout_s = 0.02, .depth_delay_s = -0.01};
  Session session = session_of_one_keyframe();
  const Eigen::Isometry3d T_keyframe_world = session.map.T_world_keyframe(KeyframeId(0)).inverse();
  SmoothingStage stage = empty;
  Walk walk;
  std::vector<MeasuredPose> measured;
  for (std::size_t i = 0; i < frames; ++i) {
    measured.push_back(walk.next());
    // Measured before the times were known, for the first half.
    const double per_s = i < frames / 2 ? std::cos(static_cast<double>(i)) : 0;
    TimeCorrection correction;
    correction.by_times.col(0).setConstant(per_s);
    correction.by_times.col(1).setConstant(-2 * per_s);
    const Eigen::Isometry3d T_camera_world = measured.back().T_world_camera.inverse();
    const Eigen::Isometry3d T_wrong =
        perturb_left(T_camera_world, -correction.step(kTrue)).inverse();
    session.frames.push_back(
        {{measured.back().stamp_s, {}}, KeyframeId(0), T_keyframe_world * T_wrong});
    stage.add({measured.back().information, correction});
    stage.process(session, kTrue, static_cast<std::int64_t>(i));
  }
  stage.finish(session, kTrue);
  const std::vector<Eigen::Isometry3d> expected = smooth_trajectory(measured);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Eigen::Isometry3d T = T_world_frame(session, session.frames[i]);
    EXPECT_LT((T.translation() - expected[i].translation()).norm(), 1e-3) << i << ": of up to 4 cm";
  }
}

TEST(SmoothingStage, CorrectsPosesForTheTimesAsKnownAtTheEnd) {
  correct_times(300, SmoothingStage(true, {}));
}

TEST(SmoothingStage, CorrectsEarlyPosesForTheTimesWhileTheRunGoesOn) {
  correct_times(1700, SmoothingStage(true, {}, 500));
}

TEST(SmoothingStage, LeavesPosesAloneThatAreNotToBeSmoothed) {
  SmoothingStage stage(false, {});
  stage.add({Matrix6d::Identity(), {}});
  EXPECT_EQ(stage.waiting(), 0U);
}

}  // namespace
}  // namespace stillmap
