// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/logged_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

Trajectory poses_at(const std::vector<std::string>& stamps) {
  Trajectory poses;
  for (const std::string& stamp : stamps)
    poses.push_back({{std::stod(stamp), stamp}, Eigen::Isometry3d::Identity()});
  return poses;
}

CameraModel some_camera() {
  CameraModel camera;
  camera.fx = camera.fy = 500;
  return camera;
}

constexpr const char* kLines =
    R"({"stamp":"1.5","objects":[]}
{"stamp":"1.6","objects":[{"track":3,"class":"person","category":"dynamic","state":"dynamic",)"
    R"("reason":"x","motion":"moving","by":null,"person":null,"box":[100,50,200,350],"filled":false,)"
    R"("p_world":[0.5,0,2],"v_world":[0.1,0,0]}]}
)";

TEST(LoggedFrames, AreThoseOfTheObjects) {
  const std::vector<ViewedFrame> frames = logged_frames({.trajectory = poses_at({"1.6"}),
                                                         .keyframes = poses_at({"1.6"}),
                                                         .objects_jsonl = kLines,
                                                         .objects_name = "objects.jsonl",
                                                         .camera = some_camera()});
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].status, TrackingStatus::kLost);
  EXPECT_EQ(frames[1].status, TrackingStatus::kTracked);
  EXPECT_TRUE(frames[1].keyframe);
  ASSERT_EQ(frames[1].objects.size(), 1U);
  const ViewedObject& person = frames[1].objects[0];
  EXPECT_EQ(person.track, 3U);
  EXPECT_TRUE(person.dynamic);
  EXPECT_EQ(person.p_world->z(), 2.0);
  EXPECT_DOUBLE_EQ(person.size_m.x(), 100 * 2.0 / 500);
  EXPECT_DOUBLE_EQ(person.size_m.y(), 300 * 2.0 / 500);
}

TEST(LoggedFrames, AreThoseOfTheTrajectoryWithoutObjects) {
  const std::vector<ViewedFrame> frames = logged_frames({.trajectory = poses_at({"1", "2"})});
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].number, 1U);
  EXPECT_EQ(frames[1].status, TrackingStatus::kTracked);
}

TEST(LoggedFrames, RefuseOtherLinesWithTheirNumber) {
  for (const char* line : {"x",
                           "{}",
                           "[]",
                           R"({"stamp":"a","objects":[]})",
                           R"({"stamp":"1","objects":[{}]})",
                           R"({"stamp":"1","objects":[{"track":"3"}]})"}) {
    const std::string text = std::string(R"({"stamp":"1","objects":[]})") + "\n" + line + "\n";
    try {
      (void)logged_frames({.objects_jsonl = text, .objects_name = "objects.jsonl"});
      ADD_FAILURE() << line;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("objects.jsonl:2: "));
    }
  }
}

TEST(LoggedFrames, AreThoseOfTheTrajectoryAndTheLostOnesInOrder) {
  const std::vector<ViewedFrame> frames =
      logged_frames({.trajectory = poses_at({"1", "3"}), .lost = {{2, "2"}}});
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].stamp.text, "2");
  EXPECT_EQ(frames[1].status, TrackingStatus::kLost);
  EXPECT_EQ(frames[2].status, TrackingStatus::kTracked);
}

TEST(LoggedFrames, AreEvenlySpreadWhereTheyAreTooMany) {
  const std::vector<ViewedFrame> frames = logged_frames({.objects_jsonl = kLines}, 1);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].stamp.text, "1.5");
  const std::vector<ViewedFrame> some =
      logged_frames({.trajectory = poses_at({"0", "1", "2", "3"})}, 2);
  ASSERT_EQ(some.size(), 2U);
  EXPECT_EQ(some[1].number, 2U);
}

TEST(LoggedDrops, AreThoseOfALiveRun) {
  EXPECT_EQ(logged_drops(R"({"live": {"dropped": 7}})"), 7U);
  for (const char* other : {"",
                            "x",
                            "[]",
                            "{}",
                            R"({"live": null})",
                            R"({"live": {"dropped": -1}})",
                            R"({"live": {"dropped": "7"}})"}) {
    EXPECT_EQ(logged_drops(other), 0U) << other;
  }
}

}  // namespace
}  // namespace stillmap
