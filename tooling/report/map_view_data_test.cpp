// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_view_data.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using nlohmann::json;
using testing::ElementsAre;

std::vector<std::uint8_t> decode(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6U) | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(count)));
  }
  return bytes;
}

StampedPose pose_at(double seconds, const Eigen::Vector3d& place) {
  StampedPose pose;
  pose.stamp.seconds = seconds;
  pose.T_world_camera.translation() = place;
  return pose;
}

// A wavy sheet of `count` points, each with its own colour.
PointCloud sheet(int count) {
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i);
    cloud.positions.emplace_back(std::cos(t), 0.01F * std::sin(3 * t), 2.0F + std::sin(1.7F * t));
    cloud.colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 9});
  }
  return cloud;
}

TEST(EvenlySpread, ExactlyTheLimitWithoutRepetition) {
  EXPECT_THAT(evenly_spread(3, 5), ElementsAre(0, 1, 2));
  EXPECT_THAT(evenly_spread(10, 4), ElementsAre(0, 2, 5, 7));
  EXPECT_TRUE(evenly_spread(0, 4).empty());
  EXPECT_TRUE(evenly_spread(4, 0).empty());
  const std::vector<std::size_t> many = evenly_spread(1'000'003, 150'000);
  EXPECT_EQ(many.size(), 150'000U);
  EXPECT_LT(many.back(), 1'000'003U);
  for (std::size_t i = 1; i < many.size(); ++i) ASSERT_LT(many[i - 1], many[i]);
}

TEST(ContinuousParts, AreCutAtGaps) {
  const Trajectory poses = {
      pose_at(1.0, {0, 0, 0}), pose_at(1.5, {1, 0, 0}), pose_at(2.1, {2, 0, 0})};
  const std::vector<std::vector<Eigen::Vector3d>> parts = continuous_parts(poses);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].size(), 2U);
  EXPECT_EQ(parts[1][0].x(), 2);
  EXPECT_TRUE(continuous_parts({}).empty());
}

TEST(MapViewJson, DecodesToThePointsWithinHalfAStep) {
  const PointCloud cloud = sheet(5000);
  const SceneFrame scene = scene_frame(cloud, {});
  const json j = json::parse(map_view_json(cloud, scene, {}, {}, 1000));
  ASSERT_EQ(j.at("points"), 1000);
  const std::vector<std::uint8_t> positions = decode(j.at("positions"));
  const std::vector<std::uint8_t> colors = decode(j.at("colors"));
  ASSERT_EQ(positions.size(), 6000U);
  ASSERT_EQ(colors.size(), 3000U);
  for (std::size_t n = 0; n < 1000; ++n) {
    const std::size_t i = static_cast<std::size_t>(colors[3 * n]) + 256U * colors[3 * n + 1];
    const Eigen::Vector3d p = scene.R_level_world * cloud.positions[i].cast<double>();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = j.at("step").at(axis);
      const unsigned code = positions[6 * n + 2 * axis] + 256U * positions[6 * n + 2 * axis + 1];
      const double value = j.at("low").at(axis).get<double>() + code * step;
      ASSERT_NEAR(value, p[static_cast<Eigen::Index>(axis)], 0.51 * step);
      ASSERT_LT(step, 2.1 / 65535);
    }
  }
}

TEST(MapViewJson, NeverMorePointsThanTheLimit) {
  const PointCloud cloud = sheet(200'000);
  const json j = json::parse(map_view_json(cloud, scene_frame(cloud, {}), {}, {}));
  EXPECT_EQ(j.at("points"), 150'000);
}

TEST(MapViewJson, PathsFrustaAndTheFirstView) {
  const PointCloud cloud = sheet(100);
  const Trajectory cameras = {
      pose_at(0, {0, 0, 0}), pose_at(0.1, {0.5, 0, 0}), pose_at(9, {1, 0, 0})};
  const SceneFrame scene = scene_frame(cloud, cameras);
  const json j = json::parse(map_view_json(cloud, scene, cameras, {cameras[1]}));
  ASSERT_EQ(j.at("paths").size(), 2U);
  const Eigen::Vector3d second = scene.R_level_world * Eigen::Vector3d(0.5, 0, 0);
  EXPECT_NEAR(j.at("paths").at(0).at(3), second.x(), 6e-4);
  EXPECT_NEAR(j.at("paths").at(0).at(5), second.z(), 6e-4);
  EXPECT_EQ(j.at("frusta").size(), 48U);
  // The view's angles and distance lead back to the eye of the picture's view.
  const double yaw = j.at("view").at("yaw");
  const double pitch = j.at("view").at("pitch");
  const Eigen::Vector3d back(
      std::cos(pitch) * std::sin(yaw), -std::sin(pitch), -std::cos(pitch) * std::cos(yaw));
  const Eigen::Vector3d eye =
      scene.box.merged(scene.cameras).center() + j.at("view").at("distance").get<double>() * back;
  const View view = view_along(scene, 1600, 900);
  EXPECT_TRUE((view.T_camera_world * (scene.R_level_world.transpose() * eye)).isZero(1e-9));
  EXPECT_GT(pitch, 0.1);
  EXPECT_NEAR(j.at("head_y"), scene.cameras.center().y() - 0.4, 1e-9);
}

TEST(MapViewJson, OfNothing) {
  const PointCloud cloud;
  const json j = json::parse(map_view_json(cloud, scene_frame(cloud, {}), {}, {}));
  EXPECT_EQ(j.at("points"), 0);
  EXPECT_EQ(j.at("positions"), "");
  EXPECT_TRUE(j.at("paths").empty());
}

}  // namespace
}  // namespace stillmap
