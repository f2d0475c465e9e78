// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_map.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;

Eigen::Isometry3d at(double x, double y = 0, double z = 0) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

Stamp stamp(int seconds) {
  return {static_cast<double>(seconds), std::to_string(seconds)};
}

// Turned by a quarter about z: x goes to y.
Eigen::Isometry3d quarter_turn_at(double x) {
  const double half = std::numbers::pi / 4;
  return make_pose(Eigen::Quaterniond(std::cos(half), 0, 0, std::sin(half)), {x, 0, 0});
}

// Key frames 0 (submap 0), 1 (submap 3), 2 (submap 3, dropped, fixed to 1), 3 (submap 0).
class SessionMap : public testing::Test {
 protected:
  SessionMap() {
    add_keyframe(0, at(1));
    add_keyframe(3, quarter_turn_at(10));
    add_keyframe(3, at(10, 5));
    add_keyframe(0, at(2));
    session_.map.remove_keyframe(KeyframeId(2), KeyframeId(1));
  }

  void add_keyframe(std::uint32_t submap, const Eigen::Isometry3d& T_world_camera) {
    Keyframe keyframe;
    keyframe.submap = SubmapId(submap);
    keyframe.stamp = stamp(static_cast<int>(session_.map.keyframes().size()) * 100);
    keyframe.T_world_camera = T_world_camera;
    keyframe.features = std::make_shared<const Features>();
    session_.map.add_keyframe(std::move(keyframe));
  }

  void add_frame(std::uint32_t reference, const Eigen::Isometry3d& T_reference_frame) {
    const int number = static_cast<int>(session_.frames.size());
    session_.frames.push_back({stamp(number), KeyframeId(reference), T_reference_frame});
  }

  static std::vector<std::string> stamps(const Trajectory& trajectory) {
    std::vector<std::string> texts;
    for (const StampedPose& pose : trajectory) texts.push_back(pose.stamp.text);
    return texts;
  }

  Session session_{{}, "", Map({1.0F}), {}, {}, {}};
};

TEST_F(SessionMap, FrameStandsWhereItsKeyFrameIs) {
  add_frame(1, at(0.5));
  const Eigen::Isometry3d T = T_world_frame(session_, session_.frames[0]);
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(10, 0.5, 0), 1e-12));
  EXPECT_EQ(submap_of(session_, session_.frames[0]), SubmapId(3));
}

TEST_F(SessionMap, FrameOfADroppedKeyFrameMovesWithItsAnchor) {
  add_frame(2, at(0, 0, 1));
  EXPECT_EQ(submap_of(session_, session_.frames[0]), SubmapId(3));
  EXPECT_TRUE(T_world_frame(session_, session_.frames[0])
                  .translation()
                  .isApprox(Eigen::Vector3d(10, 5, 1), 1e-12));
  // Key frame 2 was 5 along what the anchor has as its x axis.
  session_.map.set_pose(KeyframeId(1), at(20));
  EXPECT_TRUE(T_world_frame(session_, session_.frames[0])
                  .translation()
                  .isApprox(Eigen::Vector3d(25, 0, 1), 1e-12));
}

TEST_F(SessionMap, MainSubmapHasMostFrames) {
  EXPECT_FALSE(main_submap(session_).valid());
  add_frame(0, at(0));
  add_frame(3, at(0));
  add_frame(1, at(0));
  EXPECT_EQ(main_submap(session_), SubmapId(0));
  add_frame(2, at(0));
  EXPECT_EQ(main_submap(session_), SubmapId(0));  // two each: the lowest
  EXPECT_EQ(main_submap(session_, 1), SubmapId(3));
  EXPECT_FALSE(main_submap(session_, 4).valid());
  EXPECT_FALSE(main_submap(session_, 5).valid());
}

TEST_F(SessionMap, TrajectoriesAreOfOneSubmap) {
  add_frame(0, at(0.25));
  add_frame(1, at(0));
  add_frame(3, at(0));
  add_frame(2, at(0));
  EXPECT_THAT(stamps(trajectory_in(session_, SubmapId(0))), ElementsAre("0", "2"));
  EXPECT_THAT(stamps(trajectory_in(session_, SubmapId(0), 1)), ElementsAre("2"));
  EXPECT_THAT(stamps(trajectory_in(session_, SubmapId(3))), ElementsAre("1", "3"));
  EXPECT_TRUE(trajectory_in(session_, SubmapId{}).empty());
  EXPECT_EQ(trajectory_in(session_, SubmapId(0))[0].T_world_camera.translation().x(), 1.25);
  EXPECT_THAT(stamps(keyframes_in(session_, SubmapId(0))), ElementsAre("0", "300"));
  EXPECT_THAT(stamps(keyframes_in(session_, SubmapId(3))), ElementsAre("100"));
  EXPECT_EQ(keyframes_in(session_, SubmapId(0))[1].T_world_camera.translation().x(), 2);
}

// The camera moves by 10 cm in 0.1 s; its depth is taken 0.02 s earlier or later.
TEST_F(SessionMap, ViewStandsWhereTheCameraWasWhenItsDepthWasTaken) {
  const auto x_of_view = [&](std::uint32_t frame, double depth_after_color_s) {
    session_.views = {{frame, std::make_shared<const StaticView>(), depth_after_color_s}};
    return posed_views(session_, SubmapId(0)).at(0).T_world_camera.translation().x();
  };
  for (int i = 0; i < 3; ++i) {
    session_.frames.push_back({{5 + 0.1 * i, ""}, KeyframeId(0), at(0.1 * i)});
  }
  EXPECT_EQ(x_of_view(1, 0), 1.1);
  EXPECT_NEAR(x_of_view(1, 0.02), 1.12, 1e-9);
  EXPECT_NEAR(x_of_view(1, -0.02), 1.08, 1e-9);
  EXPECT_NEAR(x_of_view(2, 0.02), 1.22, 1e-9) << "goes on as since the frame before";
  EXPECT_NEAR(x_of_view(0, -0.02), 0.98, 1e-9);
  const FrameRecord second = session_.frames[1], third = session_.frames[2];
  session_.frames.set(
      1, {second.stamp, KeyframeId(1), second.T_reference_frame});  // of another submap
  EXPECT_EQ(x_of_view(0, 0.02), 1.0) << "the motion is not known";
  session_.frames.set(1, second);
  session_.frames.set(2, {{9, ""}, third.reference, third.T_reference_frame});
  EXPECT_NEAR(x_of_view(1, 0.02), 1.12, 1e-9) << "the next frame is too late to tell";
}

}  // namespace
}  // namespace stillmap
