// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_state.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using Json = nlohmann::json;

// The head of a message, read as docs/view.md says.
Json head_of(const std::string& message) {
  if (message.empty()) return nullptr;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(message.at(i)); };
  const std::size_t size = byte(0) + 256U * byte(1) + 65536U * byte(2);
  return Json::parse(message.substr(4, size));
}

ViewInbox::Contents frames(std::uint32_t begin, std::uint32_t end) {
  ViewInbox::Contents news;
  for (std::uint32_t i = begin; i < end; ++i) {
    ViewedFrame frame;
    frame.number = i;
    frame.stamp = {i / 30.0, std::to_string(i)};
    frame.status = TrackingStatus::kTracked;
    frame.T_world_camera.translation().x() = i;
    news.frames.push_back(frame);
  }
  return news;
}

PointCloud line_of_points(std::size_t count) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions.emplace_back(static_cast<float>(i) * 1e-4F, 0.0F, 1.0F);
    cloud.colors.push_back({1, 2, 3});
  }
  return cloud;
}

std::size_t points_in(const Json& head) {
  std::size_t points = 0;
  if (head.contains("points")) {
    for (const Json& part : head["points"]) points += part[4].get<std::size_t>();
  }
  return points;
}

TEST(ViewState, APageGetsWhatItLacksOnce) {
  ViewState state({.title = "office </script>", .frames = 40, .camera = {}});
  state.apply(frames(0, 3));
  PageProgress page;
  const Json first = head_of(state.next_message(page));
  EXPECT_EQ(first["start"]["title"], "office </script>");
  EXPECT_EQ(first["start"]["frames"], 40);
  EXPECT_EQ(first["frames"].size(), 3U);
  EXPECT_EQ(first["frames"][2]["p"][0], 2.0);
  EXPECT_TRUE(state.next_message(page).empty());
  state.apply(frames(3, 5));
  const Json second = head_of(state.next_message(page));
  EXPECT_FALSE(second.contains("start"));
  ASSERT_EQ(second["frames"].size(), 2U);
  EXPECT_EQ(second["frames"][0]["n"], 3);
  PageProgress late;
  EXPECT_EQ(head_of(state.next_message(late))["frames"].size(), 5U);
}

TEST(ViewState, LongRunsComeInParts) {
  ViewState state({.title = "", .frames = {}, .camera = {}});
  const auto all = static_cast<std::uint32_t>(2 * ViewState::kMessageFrames + 1);
  state.apply(frames(0, all));
  PageProgress page;
  std::size_t received = 0;
  for (const std::size_t expected :
       {ViewState::kMessageFrames, ViewState::kMessageFrames, std::size_t{1}}) {
    const Json head = head_of(state.next_message(page));
    EXPECT_EQ(head["frames"].size(), expected);
    received += head["frames"].size();
    EXPECT_EQ(head.contains("more"), received < all);
  }
  EXPECT_TRUE(state.next_message(page).empty());
}

TEST(ViewState, ThePictureIsTheNewest) {
  ViewState state({.title = "", .frames = {}, .camera = {}});
  PageProgress page;
  for (std::uint32_t i = 0; i < 3; ++i) {
    ViewInbox::Contents news = frames(i, i + 1);
    news.newest.emplace();
    news.newest->first.id = FrameId(i);
    news.newest->first.color = ColorImage(cv::Mat3b(8, 8, cv::Vec3b(1, 2, 3)));
    state.apply(std::move(news));
  }
  EXPECT_EQ(head_of(state.next_message(page))["picture"]["n"], 2);
  EXPECT_TRUE(state.next_message(page).empty());
}

TEST(ViewState, TheEndReplacesMapAndPoses) {
  ViewState state({.title = "", .frames = {}, .camera = {}});
  ViewInbox::Contents news = frames(0, 3);
  news.frames[1].objects.push_back({.track = 9,
                                    .class_name = "person",
                                    .motion = "moving",
                                    .box = {},
                                    .p_world = Eigen::Vector3d(1, 0, 4),
                                    .velocity_m_s = Eigen::Vector3d::UnitX()});
  state.apply(std::move(news));
  PageProgress page;
  (void)state.next_message(page);
  ViewedEnd end;
  end.map = line_of_points(ViewState::kMessagePoints + 10);
  for (std::uint32_t i = 0; i < 2; ++i) {  // the third frame was in another submap
    end.trajectory.push_back({{i / 30.0, std::to_string(i)}, Eigen::Isometry3d::Identity()});
    end.trajectory.back().T_world_camera.translation().y() = 10.0 + i;
  }
  end.keyframes = {end.trajectory[0]};
  end.united_tracks = {{TrackId(9), TrackId(4)}};
  ViewInbox::Contents last;
  last.end = std::move(end);
  state.apply(std::move(last));
  const Json head = head_of(state.next_message(page));
  EXPECT_TRUE(head["state"]["finished"]);
  EXPECT_EQ(head["state"]["keyframes"].size(), 1U);
  EXPECT_TRUE(head["framesAnew"]);
  ASSERT_EQ(head["frames"].size(), 3U);
  EXPECT_EQ(head["frames"][1]["p"][1], 11.0);
  EXPECT_FALSE(head["frames"][2].contains("p"));
  // The object moves with the camera that saw it, from (1, 0, 0) to (0, 11, 0).
  EXPECT_EQ(head["frames"][1]["o"][0]["p"], Json({0.0, 11.0, 4.0}));
  EXPECT_EQ(head["frames"][1]["o"][0]["i"], 4);
  EXPECT_TRUE(head["pointsAnew"]);
  EXPECT_EQ(points_in(head), ViewState::kMessagePoints);
  EXPECT_EQ(points_in(head_of(state.next_message(page))), 10U);
  EXPECT_TRUE(state.next_message(page).empty());
}

}  // namespace
}  // namespace stillmap
