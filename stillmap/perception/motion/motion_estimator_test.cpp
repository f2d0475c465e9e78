// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/motion_estimator.hpp"

#include <array>
#include <cmath>
#include <memory>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/perception/motion/dynamic_objects.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "tests/support/dynamics_frames.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

constexpr int kSize = 40;  // of the square that represents an object, pixels

/// A frame in which a square, facing the camera, has its middle at a point of the world.
struct Snapshot {
  FrameObjects objects;
  DepthImage depth{cv::Mat1f(480, 640, 6.0F)};
  std::vector<ObjectState> states;
  Eigen::Isometry3d T_world_camera;
};

Snapshot look(int frame,
              const Eigen::Vector3d& p_world,
              const Eigen::Isometry3d& T_world_camera,
              StateReason reason = StateReason::kBoxesApart,
              int jitter_px = 0) {
  const CameraModel camera = builtin_camera("tum_fr3");
  const Eigen::Vector3d p_camera = T_world_camera.inverse() * p_world;
  const Eigen::Vector2d middle = camera.project(p_camera);
  Snapshot shot;
  shot.T_world_camera = T_world_camera;
  shot.objects.frame = FrameId(static_cast<std::uint32_t>(frame));
  shot.objects.stamp = {10.0 + frame / 30.0, ""};
  const int x = static_cast<int>(std::lround(middle.x())) - kSize / 2 + jitter_px;
  const int y = static_cast<int>(std::lround(middle.y())) - kSize / 2;
  const PixelBox box{static_cast<double>(x),
                     static_cast<double>(y),
                     static_cast<double>(x + kSize),
                     static_cast<double>(y + kSize)};
  shot.objects.objects.push_back(tracked_object("chair", box));
  shot.objects.mask = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  const cv::Rect pixels = cv::Rect(x, y, kSize, kSize) & cv::Rect(0, 0, 640, 480);
  shot.objects.mask.mat(pixels).setTo(1);
  const auto z = static_cast<float>(p_camera.z());
  shot.depth.mat(pixels).setTo(z);
  ObjectState state;
  state.track = TrackId(1);
  state.category = Category::kPotentiallyDynamic;
  state.reason = reason;
  state.dynamic = reason == StateReason::kTouching;
  if (state.dynamic) state.person = TrackId(77);
  state.box = box;
  state.depths = DepthInterval{z - 0.01F, z + 0.01F};
  state.median_depth_m = z;
  shot.states.push_back(state);
  return shot;
}

Motion feed(MotionEstimator& states, const Snapshot& shot) {
  return states.update(shot.objects, shot.depth, shot.states, shot.T_world_camera).at(0);
}

/// A hand-held camera: swings and sways.
Eigen::Isometry3d camera_at(int frame) {
  const double s = frame / 30.0;
  return make_pose(so3_exp({0.1 * std::sin(2 * s), 0.15 * std::sin(3 * s), 0.05 * std::sin(s)}),
                   {0.2 * std::sin(2.5 * s), 0.1 * std::cos(2 * s), 0.1 * s});
}

TEST(RobustVelocity, OfAStraightWayWithAnOutlier) {
  std::vector<double> stamps;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 10; ++i) {
    stamps.push_back(5.0 + 0.1 * i);
    places.emplace_back(1.0 + 0.05 * i, 2.0, 3.0 - 0.02 * i);
  }
  places[6] += Eigen::Vector3d(4, 4, 4);
  const RobustVelocity found = robust_velocity(stamps, places, 0.01);
  EXPECT_NEAR((found.velocity - Eigen::Vector3d(0.5, 0, -0.2)).norm(), 0, 1e-9);
  // No scatter but the outlier's: 0.01 over the root of the sum of (0.1 k - 0.45)^2 = 0.825.
  EXPECT_NEAR(found.error, 0.01 / std::sqrt(0.825), 1e-9);
}

TEST(MotionEstimator, AStillObjectStaysStillWhateverTheCameraDoes) {
  MotionEstimator states({}, builtin_camera("tum_fr3"));
  for (int i = 0; i < 60; ++i) {
    const Motion motion = feed(states, look(i, {0.1, 0.0, 2.5}, camera_at(i)));
    EXPECT_EQ(motion.state, i < 4 ? MotionState::kUnknown : MotionState::kStill) << i;
    ASSERT_TRUE(motion.p_world);
    EXPECT_LT((*motion.p_world - Eigen::Vector3d(0.1, 0.0, 2.5)).norm(), 0.01);
  }
  EXPECT_TRUE(states.moving().empty());
}

TEST(MotionEstimator, AMovingObjectHasItsVelocityInTheWorld) {
  MotionEstimator states({}, builtin_camera("tum_fr3"));
  Motion motion;
  const Eigen::Vector3d velocity(0.4, 0.0, 0.3);
  for (int i = 0; i < 20; ++i) {
    motion =
        feed(states, look(i, Eigen::Vector3d(-0.2, 0, 2.0) + velocity * i / 30.0, camera_at(i)));
  }
  EXPECT_EQ(motion.state, MotionState::kMoving);
  EXPECT_LT((motion.velocity_m_s - velocity).norm(), 0.05);
  EXPECT_EQ(states.moving(), std::vector<TrackId>{TrackId(1)});
}

TEST(MotionEstimator, PushedThenRollingThenStill) {
  MotionEstimator states({}, builtin_camera("tum_fr3"));
  Eigen::Vector3d place(-0.3, 0, 2.5);
  std::array<MotionState, 60> seen{};
  for (int i = 0; i < 60; ++i) {
    if (i >= 10 && i < 35) place.x() += 0.6 / 30.0;
    const bool touched = i < 25;
    const StateReason reason = touched ? StateReason::kTouching : StateReason::kBoxesApart;
    const Motion motion = feed(states, look(i, place, camera_at(i), reason));
    seen[static_cast<std::size_t>(i)] = motion.state;
    EXPECT_EQ(motion.by.has_value(), motion.state == MotionState::kMovedBySomeone);
  }
  EXPECT_EQ(seen[9], MotionState::kStill);
  EXPECT_EQ(seen[22], MotionState::kMovedBySomeone);
  EXPECT_EQ(seen[30], MotionState::kMoving);  // the hand has left
  EXPECT_EQ(seen[37], MotionState::kMoving);  // it takes some frames to be sure
  EXPECT_EQ(seen[55], MotionState::kStill);
}

TEST(MotionEstimator, WhatHasStoodSinceItWasFirstSeenStands) {
  MotionStateConfig config;
  config.standing_frames = 20;
  MotionEstimator states(config, builtin_camera("tum_fr3"));
  for (int i = 0; i < 60; ++i) {
    (void)feed(states, look(i, {0.1, 0.0, 2.5}, camera_at(i)));
    EXPECT_EQ(states.standing().size(), i < 4 + 19 ? 0U : 1U) << i;
  }
  Eigen::Vector3d place(0.1, 0.0, 2.5);
  for (int i = 60; i < 160; ++i) {  // it leaves, then stands elsewhere for long
    if (i < 80) place.x() -= 0.6 / 30.0;
    (void)feed(states, look(i, place, camera_at(i)));
    if (i <= 70) continue;
    EXPECT_TRUE(states.standing().empty()) << i;
  }
}

TEST(MotionEstimator, AFlickeringMaskIsNoMotion) {
  MotionEstimator states({}, builtin_camera("tum_fr3"));
  for (int i = 0; i < 60; ++i) {
    const int jitter = (i * 7919) % 13 - 6;
    const Motion motion =
        feed(states, look(i, {0.1, 0, 2.5}, camera_at(i), StateReason::kBoxesApart, jitter));
    EXPECT_NE(motion.state, MotionState::kMoving) << i;
  }
}

TEST(MotionEstimator, FarAwayItTakesMoreToCountAsMoving) {
  MotionStateConfig config;
  config.depth_noise_per_m = 0.01;
  const Eigen::Vector3d velocity(0.4, 0, 0);
  for (const double distance : {1.0, 5.0}) {
    MotionEstimator states(config, builtin_camera("tum_fr3"));
    Motion motion;
    for (int i = 0; i < 15; ++i) {
      motion = feed(states,
                    look(i,
                         Eigen::Vector3d(-0.1, 0, distance) + velocity * i / 30.0,
                         Eigen::Isometry3d::Identity()));
    }
    EXPECT_EQ(motion.state, distance < 2 ? MotionState::kMoving : MotionState::kStill);
  }
}

TEST(MotionEstimator, WithoutDepthOrWhenFilledInNothingIsKnown) {
  MotionEstimator states({}, builtin_camera("tum_fr3"));
  for (int i = 0; i < 10; ++i) {
    Snapshot shot = look(i, {0.1 * i, 0, 2.0}, camera_at(i));
    shot.states[0].depths.reset();
    const Motion motion = feed(states, shot);
    EXPECT_EQ(motion.state, MotionState::kUnknown);
    EXPECT_FALSE(motion.p_world);
  }
  for (int i = 10; i < 20; ++i) {
    Snapshot shot = look(i, {0.1 * i - 1, 0, 2.0}, camera_at(i));
    shot.objects.objects[0].filled = BoxOrigin{FrameId(1), std::nullopt};
    EXPECT_EQ(feed(states, shot).state, MotionState::kUnknown);
  }
}

/// The truth's id that most pixels of an object have; 0 when that is none.
int true_id(const FrameObjects& frame, int id, const cv::Mat1b& truth) {
  std::array<int, 100> votes{};
  for (int row = 0; row < truth.rows; ++row) {
    for (int x = 0; x < truth.cols; ++x) {
      if (frame.mask.mat(row, x) == id) ++votes[truth(row, x)];
    }
  }
  return static_cast<int>(std::ranges::max_element(votes) - votes.begin());
}

struct MotionScore {
  int fast_known = 0, fast_moving = 0;    // people faster than 0.4 m/s
  int still_known = 0, still_moving = 0;  // what never moves
};

/// The motion states of all frames of a sequence, at true poses.
MotionScore score_motion(const TruthSequence& data) {
  const Sequence& sequence = data.sequence();
  const Trajectory poses = sequence.groundtruth().value().poses;
  const DynamicObjects dynamics({}, sequence.camera(), dynamics_mode("mask"));
  MotionEstimator states({}, sequence.camera());
  ObjectTracker tracker({}, FillRule::kCausal);
  MotionScore score;
  for (std::uint32_t i = 0; i < sequence.size(); ++i) {
    const FramePtr frame = sequence.read(FrameId(i));
    const std::optional<FrameObjects> objects =
        tracker.push({frame->id, data.detections(i), frame->depth});
    const DynamicsResult judged = dynamics.judge(frame->depth, *objects, {});
    const std::vector<Motion> motions =
        states.update(*objects, frame->depth, judged.states, pose_at(poses, frame->stamp.seconds));
    const TruthSequence::Frame truth = data.truth(i);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      if (objects->objects[k].filled || motions[k].state == MotionState::kUnknown) continue;
      const int id = true_id(*objects, static_cast<int>(k) + 1, truth.ids);
      const double speed = id == 0 ? 0.0 : truth.speeds.at(id);
      const int moving = motions[k].state == MotionState::kMoving ? 1 : 0;
      if (id > 0 && id < 10 && speed > 0.4) {
        ++score.fast_known;
        score.fast_moving += moving;
      } else if ((id == 0 || id >= 10) && speed < 0.02) {
        ++score.still_known;
        score.still_moving += moving;
      }
    }
  }
  return score;
}

TEST(MotionEstimator, TellPeopleWhoWalkFromWhatStandsOnTruth) {
  for (const char* name : {"twin_walking_xyz", "fr1_xyz_walkers"}) {
    STILLMAP_NEED_SHARED_DATA(name);
    const TruthSequence data(shared_data(name));
    const MotionScore score = score_motion(data);
    const std::string what = fmt::format("{}: {} of {} who walk move, {} of {} that stand",
                                         name,
                                         score.fast_moving,
                                         score.fast_known,
                                         score.still_moving,
                                         score.still_known);
    SCOPED_TRACE(what);
    fmt::print("{}\n", what);
    ASSERT_GT(score.fast_known, 100);
    ASSERT_GT(score.still_known, 100);
    EXPECT_GT(score.fast_moving, 0.5 * score.fast_known);
    EXPECT_LT(score.still_moving, 0.06 * score.still_known);
  }
}

}  // namespace
}  // namespace stillmap
