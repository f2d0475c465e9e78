// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/scene_message.hpp"

#include <deque>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using nlohmann::json;
using testing::ElementsAre;

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

TEST(SceneMessage, StartSaysWhatIsKnown) {
  const json bare = json::parse(start_json({.title = "a \"b\" \xff", .frames = {}, .camera = {}}));
  EXPECT_EQ(bare["title"], "a \"b\" \xEF\xBF\xBD");
  EXPECT_TRUE(bare["frames"].is_null());
  EXPECT_FALSE(bare.contains("camera"));
  EXPECT_FALSE(bare.contains("step"));
  const json full = json::parse(
      start_json({.title = "", .frames = 7, .camera = builtin_camera("tum_fr1"), .step_s = 0.5}));
  EXPECT_EQ(full["frames"], 7);
  EXPECT_EQ(full["camera"]["width"], 640);
  EXPECT_EQ(full["step"], 0.5);
}

TEST(SceneMessage, StateHasTheLayoutAndAtTheEndKeyFrames) {
  SceneState state{.dropped = 3, .left_out = 1};
  const json before = json::parse(state_json(state, 10));
  EXPECT_EQ(before["dropped"], 3);
  EXPECT_FALSE(before.contains("finished"));
  EXPECT_FALSE(before.contains("box"));
  state.finished = true;
  state.layout.R_level_world = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  state.layout.box.extend(Eigen::Vector3d(-1, -2, 0));
  state.layout.box.extend(Eigen::Vector3d(1.5, 1, 4));
  state.layout.head_y = -0.75;
  state.keyframes.resize(25);
  state.keyframes[5].T_world_camera.translation().z() = 9;
  const json after = json::parse(state_json(state, 5));
  EXPECT_TRUE(after["finished"]);
  EXPECT_EQ(after["box"], json({-1.0, -2.0, 0.0, 1.5, 1.0, 4.0}));
  EXPECT_EQ(after["head"], -0.75);
  EXPECT_DOUBLE_EQ(after["level"][5], -std::sin(0.5));
  ASSERT_EQ(after["keyframes"].size(), 5U);
  EXPECT_EQ(after["keyframes"][1], json({0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 1.0}));
}

TEST(SceneMessage, FramesAreThoseAskedFor) {
  std::deque<ViewedFrame> frames(4);
  for (std::uint32_t i = 0; i < 4; ++i) frames[i].number = i;
  const json list = json::parse(frames_json(frames, 1, 3));
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1]["n"], 2);
  EXPECT_EQ(frames_json(frames, 2, 2), "[]");
}

}  // namespace
}  // namespace stillmap
