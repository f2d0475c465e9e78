// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_log.hpp"

#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace stillmap {
namespace {

using nlohmann::json;

// A person who pushes a chair, seen by a camera that looks along the world's x.
FrameResult pushed_chair(Stamp stamp) {
  FrameResult result;
  result.stamp = std::move(stamp);
  result.T_world_camera.linear() =
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  result.T_world_camera.translation() << 1, 2, 3;
  result.objects.resize(2);
  ObjectState& person = result.objects[0];
  person.track = TrackId(4);
  person.class_name = "person";
  person.category = Category::kDynamic;
  person.dynamic = true;
  person.reason = StateReason::kDynamicClass;
  person.box = {10, 20.26, 30, 40};
  person.filled = true;
  ObjectState& chair = result.objects[1];
  chair.track = TrackId(7);
  chair.class_name = "chair \"\xff";
  chair.category = Category::kPotentiallyDynamic;
  chair.dynamic = true;
  chair.reason = StateReason::kTouching;
  chair.person = TrackId(4);
  chair.box = {1, 2, 3, 4};
  chair.motion = {.state = MotionState::kMovedBySomeone,
                  .p_world = Eigen::Vector3d(3, 2, 3.00004),
                  .velocity_m_s = {0.5, 0, -0.00001},
                  .velocity_error_m_s = 0.1,
                  .by = TrackId(4)};
  return result;
}

void show(ObjectLog& log, const std::vector<FrameResult>& results) {
  for (const FrameResult& result : results) log.on_frame({}, result);
}

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

TEST(ObjectLog, SaysAllOfAnObject) {
  const FrameResult result = pushed_chair({5.0, "5.000000"});
  ObjectLog log;
  show(log, {result});
  const Trajectory as_it_was = {{{5.0, "5.000000"}, result.T_world_camera}};
  const std::vector<json> lines = lines_of(log.jsonl(as_it_was));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].at("stamp"), "5.000000");
  const json& objects = lines[0].at("objects");
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0],
            (json{{"track", 4},
                  {"class", "person"},
                  {"category", "dynamic"},
                  {"state", "dynamic"},
                  {"reason", "dynamic class"},
                  {"motion", "unknown"},
                  {"by", nullptr},
                  {"person", nullptr},
                  {"box", {10.0, 20.3, 30.0, 40.0}},
                  {"filled", true},
                  {"p_world", nullptr},
                  {"v_world", nullptr}}));
  EXPECT_EQ(objects[1].at("class"), "chair \"\xEF\xBF\xBD");
  EXPECT_EQ(objects[1].at("category"), "potentially dynamic");
  EXPECT_EQ(objects[1].at("reason"), "somebody at it");
  EXPECT_EQ(objects[1].at("motion"), "moved by someone");
  EXPECT_EQ(objects[1].at("by"), 4);
  EXPECT_EQ(objects[1].at("person"), 4);
  EXPECT_EQ(objects[1].at("p_world"), (json{3.0, 2.0, 3.0}));
  EXPECT_EQ(objects[1].at("v_world"), (json{0.5, 0.0, 0.0}));
}

TEST(ObjectLog, PlacesAreUnderFinalPoses) {
  FrameResult empty;
  empty.stamp = {4.0, "4"};
  ObjectLog log;
  show(log, {empty, pushed_chair({5.0, "5"})});
  // The chair is 2 m straight ahead of the camera; its velocity leads away from it.
  Trajectory corrected(1);
  corrected[0].stamp = {5.0, "5"};
  corrected[0].T_world_camera.translation() << 10, 20, 30;
  const std::vector<json> lines = lines_of(log.jsonl(corrected));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines[0].at("objects").empty());
  EXPECT_EQ(lines[1].at("objects")[1].at("p_world"), (json{10.0, 20.0, 32.0}));
  EXPECT_EQ(lines[1].at("objects")[1].at("v_world"), (json{0.0, 0.0, 0.5}));
}

TEST(ObjectLog, WithoutAPoseNothingIsSaidOfThePlace) {
  ObjectLog log;
  show(log, {pushed_chair({5.0, "5"})});
  const json chair = lines_of(log.jsonl({})).at(0).at("objects").at(1);
  EXPECT_TRUE(chair.at("p_world").is_null());
  EXPECT_TRUE(chair.at("v_world").is_null());
}

TEST(ObjectLog, KeysStayInOrder) {
  ObjectLog log;
  show(log, {pushed_chair({5.0, "5"})});
  const std::string text = log.jsonl({});
  EXPECT_EQ(text.substr(0, 62),
            R"({"stamp":"5","objects":[{"track":4,"class":"person","category")");
  EXPECT_EQ(text.back(), '\n');
}

TEST(ObjectLog, TracksOfOneObjectAreOneAtTheEnd) {
  ObjectLog log;
  FrameResult result = pushed_chair({5.0, "5"});
  result.objects.push_back(result.objects[0]);
  result.objects.back().track = TrackId(2);
  log.on_frame({}, result);
  RunResult end;
  end.united_tracks = {{TrackId(4), TrackId(3)}, {TrackId(3), TrackId(2)}};
  log.on_end(end);
  const json objects = lines_of(log.jsonl({})).at(0).at("objects");
  EXPECT_EQ(objects.at(0).at("track"), 2);
  EXPECT_EQ(objects.at(1).at("track"), 7);
  EXPECT_EQ(objects.at(1).at("person"), 2);
  EXPECT_EQ(objects.at(1).at("by"), 2);
  const std::vector<ObjectSummary> summaries = log.summaries();
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].frames, 1U) << "two parts in one frame";
}

TEST(ObjectLog, SumsUpEachTrack) {
  FrameResult apart = pushed_chair({2, "2"});
  apart.objects[1].dynamic = false;
  apart.objects[1].reason = StateReason::kBoxesApart;
  apart.objects[1].motion.state = MotionState::kStill;
  ObjectLog log;
  show(log, {pushed_chair({1, "1"}), apart, apart});
  const std::vector<ObjectSummary> summaries = log.summaries();
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].track, 4U);
  EXPECT_EQ(summaries[0].class_name, "person");
  EXPECT_EQ(summaries[0].category, "dynamic");
  EXPECT_EQ(summaries[0].frames, 3U);
  EXPECT_EQ(summaries[0].filled, 3U);
  EXPECT_EQ(summaries[0].dynamic, 3U);
  EXPECT_EQ(summaries[1].track, 7U);
  EXPECT_EQ(summaries[1].filled, 0U);
  EXPECT_EQ(summaries[1].dynamic, 1U);
  EXPECT_EQ(summaries[1].main_reason, "nobody near");
  ASSERT_EQ(summaries[1].motions.size(), 2U);
  EXPECT_EQ(summaries[1].motions[0].motion, "still");
  EXPECT_EQ(summaries[1].motions[0].frames, 2U);
  EXPECT_EQ(summaries[1].motions[1].motion, "moved by someone");
  EXPECT_EQ(summaries[1].motions[1].frames, 1U);
}

}  // namespace
}  // namespace stillmap
