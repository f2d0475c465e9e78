// SPDX-License-Identifier: Apache-2.0
// `stillmap export FILE.stillmap` from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/system_config.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/room.hpp"

namespace stillmap {
namespace {

// Two cameras in a room whose truth is known, each with what it is told to see, in world 2; and in
// world 0 a camera that saw something else.
class ExportSession : public Cli {
 protected:
  ExportSession() {
    room_.move(room_.T_world_room());
    SystemConfig config;
    config.dynamics.mode = "off";
    session_.config_yaml = dump_yaml(list_fields(config));
    session_.camera = room_.camera;
    add_camera(SubmapId(0), Eigen::Isometry3d::Identity(), elsewhere());
    for (const Eigen::Isometry3d& pose : {room_.poses[0], room_.poses[3]}) {
      add_camera(SubmapId(2), pose, moved(room_.cloud, pose.inverse()));
    }
    save();
  }

  void save() const { write_session(folder_ / "map.stillmap", session_); }

  static PointCloud elsewhere() {
    PointCloud cloud;
    cloud.positions = {{0, 0, 77}};
    cloud.colors = {{1, 2, 3}};
    return cloud;
  }

  void add_camera(SubmapId world,
                  const Eigen::Isometry3d& T_world_camera,
                  const PointCloud& cloud) {
    Keyframe keyframe;
    keyframe.submap = world;
    keyframe.T_world_camera = T_world_camera;
    keyframe.features = std::make_shared<const Features>();
    const auto number = static_cast<std::uint32_t>(session_.frames.size());
    keyframe.stamp = {number + 0.5, std::to_string(number) + ".5"};
    const Stamp stamp = keyframe.stamp;
    const KeyframeId id = session_.map.add_keyframe(std::move(keyframe));
    session_.frames.push_back({stamp, id, Eigen::Isometry3d::Identity()});
    session_.views.push_back(
        {number, std::make_shared<const StaticView>(StaticView{compact(cloud), {}})});
  }

  void expect_refused(const std::string& arguments, const std::string& part) const {
    Cli::expect_refused("export " + arguments, part);
  }

  TestRoom room_;
  Session session_{{}, "", Map({1.0F}), {}, {}, {}};
};

TEST_F(ExportSession, TheMapIsThatOfTheWorldWithMostFrames) {
  const Outcome outcome = run("export map.stillmap --ply a.ply");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const PointCloud map = read_ply(folder_ / "a.ply");
  // The room has a point every centimetre, as the map's voxels are.
  EXPECT_GT(map.size(), room_.cloud.size() / 2);
  EXPECT_LE(map.size(), room_.cloud.size() * 2);
  const Eigen::Isometry3d T_room_map = TestRoom().poses.front() * room_.poses.front().inverse();
  for (const Eigen::Vector3f& p : map.positions) {
    const Eigen::Vector3d in_room = T_room_map * p.cast<double>();
    ASSERT_GT(in_room.z(), -0.01);
    ASSERT_LT(in_room.z(), 2.51);
    ASSERT_GT(in_room.x(), -0.01);
    ASSERT_LT(in_room.x(), 5.01);
  }
}

TEST_F(ExportSession, AllFormatsAreThoseOfTheRunsFolder) {
  ASSERT_EQ(run("export map.stillmap --ply a.ply --octomap a.ot --pcd a.pcd --grid a.yaml").err,
            "");
  std::filesystem::create_directory(folder_ / "result");
  std::filesystem::copy(folder_ / "a.ply", folder_ / "result" / "map.ply");
  Trajectory keyframes;
  for (const KeyframeId id : {KeyframeId(1), KeyframeId(2)}) {
    const Keyframe& keyframe = session_.map.keyframe(id);
    keyframes.push_back({keyframe.stamp, keyframe.T_world_camera});
  }
  write_file_atomically(folder_ / "result" / "keyframes.txt", format_trajectory(keyframes));
  write_file_atomically(folder_ / "result" / "camera.yaml", format_camera_yaml(room_.camera));
  ASSERT_EQ(run("export result --ply b.ply --octomap b.ot --pcd b.pcd --grid b.yaml").err, "");
  EXPECT_TRUE(content("a.ply") == content("b.ply"));
  EXPECT_TRUE(content("a.pcd") == content("b.pcd"));
  EXPECT_GT(content("a.ot").size(), 10000U);
  EXPECT_TRUE(content("a.ot") == content("b.ot"));
  EXPECT_TRUE(content("a.pgm") == content("b.pgm"));
}

TEST_F(ExportSession, RefusesWhatIsNoWholeSession) {
  const std::string bytes = content("map.stillmap");
  write("a.stillmap", bytes.substr(0, bytes.size() / 2));
  expect_refused("a.stillmap --ply a.ply", "a.stillmap: truncated");
  write("a.stillmap", "ply\n");
  expect_refused("a.stillmap --ply a.ply", "a.stillmap: not a stillmap session");
  expect_refused("none.stillmap --ply a.ply", "none.stillmap: ");
  session_.config_yaml = "cloud:\n  voxel_size_m: thin\n";
  save();
  expect_refused("map.stillmap --ply a.ply", "map.stillmap: settings:2: ");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.ply"));
}

TEST_F(ExportSession, SaysThatThereIsNothingInIt) {
  session_.views.clear();
  save();
  expect_refused("map.stillmap --ply a.ply", "map.stillmap: no points");
  session_.frames = {};
  save();
  expect_refused("map.stillmap --ply a.ply", "map.stillmap: no frame");
}

TEST_F(ExportSession, NeverWritesOverItsSource) {
  std::filesystem::rename(folder_ / "map.stillmap", folder_ / "a.ply");
  expect_refused("a.ply --ply a.ply", "this is the input a.ply");
}

}  // namespace
}  // namespace stillmap
