// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_message.hpp"

#include <cmath>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using nlohmann::json;

std::string decode(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6U) | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> static_cast<unsigned>(count)));
  }
  return bytes;
}

// A message, read as docs/view.md says.
struct Read {
  explicit Read(const std::string& base64) : bytes(decode(base64)) {
    const std::size_t size = byte(0) + 256U * byte(1) + 65536U * byte(2);
    head = json::parse(bytes.substr(4, size));
    body = 4 + size;
  }
  [[nodiscard]] unsigned byte(std::size_t i) const {
    return static_cast<unsigned char>(bytes.at(i));
  }
  [[nodiscard]] unsigned at(std::size_t offset) const { return byte(body + offset); }

  std::string bytes;
  json head;
  std::size_t body = 0;
};

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

RunReport report_of(const PointCloud& map) {
  RunReport report;
  report.sequence = "office";
  report.map = &map;
  return report;
}

std::size_t points_of(const json& head) {
  std::size_t points = 0;
  for (const json& part : head["points"]) points += part[4].get<std::size_t>();
  return points;
}

TEST(MapMessage, HasThePointsWithinAStep) {
  const PointCloud cloud = sheet(5000);
  const Read message(map_message(report_of(cloud), scene_frame(cloud, {}), 1000));
  const double side = message.head["start"]["side"];
  std::size_t seen = 0;
  for (const json& part : message.head["points"]) {
    for (std::size_t n = 0; n < part[4].get<std::size_t>(); ++n, ++seen) {
      const std::size_t color = part[6].get<std::size_t>() + 3 * n;
      const std::size_t i = message.at(color) + 256U * message.at(color + 1);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t place = part[5].get<std::size_t>() + 6 * n + 2 * axis;
        const double steps = message.at(place) + 256U * message.at(place + 1);
        const double value = side * (part[1 + axis].get<double>() + steps / 65536);
        ASSERT_NEAR(value, cloud.positions[i][static_cast<Eigen::Index>(axis)], side / 65536);
      }
    }
  }
  EXPECT_EQ(seen, 1000U);
}

TEST(MapMessage, NeverMorePointsThanTheLimitAndLargerOnes) {
  const PointCloud cloud = sheet(200'000);
  const SceneFrame scene = scene_frame(cloud, {});
  const Read message(map_message(report_of(cloud), scene));
  EXPECT_EQ(points_of(message.head), kMapMessagePoints);
  EXPECT_NEAR(message.head["state"]["spacing"], scene.spacing_m * std::sqrt(200.0 / 150), 1e-3);
}

TEST(MapMessage, OfLongRunsEvenlySpreadFramesAndTheirObjects) {
  const PointCloud cloud = sheet(100);
  RunReport report = report_of(cloud);
  report.viewed.resize(3000);
  for (std::size_t i = 0; i < report.viewed.size(); ++i) {
    report.viewed[i].stamp.seconds = static_cast<double>(i);
    report.viewed[i].objects.resize(1);
  }
  report.keyframes.resize(1000);
  const Read message(map_message(report, scene_frame(cloud, {})));
  const json& frames = message.head["frames"];
  ASSERT_EQ(frames.size(), 1200U);
  std::size_t telling = 0;
  for (const json& frame : frames) telling += frame.contains("o") ? 1U : 0U;
  EXPECT_EQ(telling, 400U);
  EXPECT_NEAR(message.head["start"]["step"], 7.5, 0.05);
  EXPECT_EQ(message.head["state"]["keyframes"].size(), 300U);
  EXPECT_TRUE(message.head["state"]["finished"]);
}

TEST(MapMessage, HasWhatMovesInTheFramesThatTellIt) {
  const PointCloud cloud = sheet(100);
  RunReport report = report_of(cloud);
  report.viewed.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    report.viewed[i].number = 10 + i;
    report.viewed[i].stamp.text = fmt::format("{}.5", i);
  }
  StampedGhosts walker{report.viewed[1].stamp, {}};
  walker.points.add({0.5F, -0.25F, 2.0F}, {7, 8, 9}, 4);
  walker.points.add({-100, 0, 1000}, {1, 2, 3}, 0);  // too far for the message
  report.movers = {walker, {{99.0, "99.0"}, walker.points}};
  const Read message(map_message(report, scene_frame(cloud, {})));
  const json& movers = message.head["movers"];
  ASSERT_EQ(movers.size(), 3U);
  EXPECT_EQ(movers[0][0], 10);
  EXPECT_EQ(movers[0][1][2], 0);
  EXPECT_EQ(movers[1][0], 11);
  EXPECT_EQ(movers[1][1][2], 2);
  std::vector<unsigned> positions, colors;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t at = movers[1][1][0].get<std::size_t>() + 2 * i;
    positions.push_back(message.at(at) + 256 * message.at(at + 1));
  }
  for (std::size_t i = 0; i < 8; ++i) {
    colors.push_back(message.at(movers[1][1][1].get<std::size_t>() + i));
  }
  EXPECT_THAT(positions, testing::ElementsAre(33268, 32518, 34768, 0, 32768, 65535));
  EXPECT_THAT(colors, testing::ElementsAre(7, 8, 9, 4, 1, 2, 3, 0));
}

TEST(MapMessage, OfNothing) {
  const PointCloud cloud;
  const Read message(map_message(report_of(cloud), scene_frame(cloud, {})));
  EXPECT_FALSE(message.head.contains("points"));
  EXPECT_FALSE(message.head.contains("movers"));
  EXPECT_TRUE(message.head["frames"].empty());
  EXPECT_FALSE(message.head["start"].contains("step"));
  EXPECT_FALSE(message.head["state"].contains("box"));
}

}  // namespace
}  // namespace stillmap
