// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/report_json.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {
namespace {

using nlohmann::json;

RunReport small_report(const PointCloud& map) {
  RunReport report;
  report.version = "1.2.3";
  report.sequence = "office";
  report.camera.name = "tum_fr1";
  report.camera.k3 = 0.25;
  report.frames_total = 8;
  report.frames_tracked = 6;
  report.skipped.push_back({FrameId(1), {1.5, "1.500000"}, "rgb/b.png: truncated"});
  report.lost.push_back({2.0, "2.000"});
  report.keyframes.resize(3);
  report.wall_s = 4.5;
  report.frame_ms = {10, 20, 30, 100};
  report.stages.push_back({"match", std::vector<double>{1, 2, 3, 10}});
  report.stages.push_back({"extract", std::vector<double>{5}});
  report.peak_memory_mb = 321.5;
  report.map = &map;
  report.warnings = {"depth is sparse"};
  return report;
}

TEST(ReportJson, KnownFigures) {
  PointCloud map;
  map.positions = {{1, 2, 3}, {-1, 5, 0}};
  map.colors.resize(2);
  const json j = json::parse(report_json(small_report(map)));
  EXPECT_EQ(j.at("version"), "1.2.3");
  EXPECT_EQ(j.at("sequence"), "office");
  EXPECT_EQ(j.at("camera").at("name"), "tum_fr1");
  EXPECT_EQ(j.at("camera").at("lens"), "brown_conrady");
  EXPECT_EQ(j.at("camera").at("distortion"), (json{0.0, 0.0, 0.0, 0.0, 0.25}));
  EXPECT_EQ(j.at("frames").at("total"), 8);
  EXPECT_EQ(j.at("frames").at("tracked"), 6);
  EXPECT_EQ(j.at("frames").at("ratio"), 0.75);
  EXPECT_EQ(j.at("frames").at("skipped").at(0).at("stamp"), "1.500000");
  EXPECT_EQ(j.at("frames").at("skipped").at(0).at("message"), "rgb/b.png: truncated");
  EXPECT_EQ(j.at("frames").at("lost"), json{"2.000"});
  EXPECT_EQ(j.at("keyframes"), 3);
  EXPECT_EQ(j.at("time").at("wall_s"), 4.5);
  EXPECT_EQ(j.at("memory").at("peak_mb"), 321.5);
  EXPECT_EQ(j.at("map").at("points"), 2);
  EXPECT_EQ(j.at("map").at("bounds_min"), (json{-1.0, 2.0, 0.0}));
  EXPECT_EQ(j.at("map").at("bounds_max"), (json{1.0, 5.0, 3.0}));
  EXPECT_EQ(j.at("warnings"), json{"depth is sparse"});
}

TEST(ReportJson, GapsInTracking) {
  RunReport report;
  report.lost = {{2, "2.0"}, {3, "3.0"}, {6, "6.0"}};
  report.estimate = {{{1, "1.0"}, Eigen::Isometry3d::Identity()},
                     {{4, "4.0"}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.5))}};
  const json gaps = json::parse(report_json(report)).at("tracking").at("gaps");
  EXPECT_EQ(gaps,
            json::array({{{"first_lost", "2.0"},
                          {"frames", 2},
                          {"seconds", 2.0},
                          {"found_again", true},
                          {"found_at", "4.0"},
                          {"moved_m", 0.5}},
                         {{"first_lost", "6.0"},
                          {"frames", 1},
                          {"seconds", 0.0},
                          {"found_again", false},
                          {"found_at", nullptr},
                          {"moved_m", nullptr}}}));
  EXPECT_EQ(json::parse(report_json(RunReport{})).at("tracking").at("gaps"), json::array());
}

TEST(ReportJson, Times) {
  const PointCloud map;
  const json time = json::parse(report_json(small_report(map))).at("time");
  EXPECT_EQ(time.at("frame_ms"), (json{{"mean", 40}, {"median", 25}, {"p95", 100}, {"max", 100}}));
  EXPECT_EQ(time.at("stages_ms").size(), 2U);
  EXPECT_EQ(time.at("stages_ms").at("match"),
            (json{{"mean", 4}, {"median", 2.5}, {"p95", 10}, {"max", 10}}));
  EXPECT_EQ(time.at("stages_ms").at("extract"),
            (json{{"mean", 5}, {"median", 5}, {"p95", 5}, {"max", 5}}));
}

TEST(ReportJson, StagesOfOneNameAreTakenTogether) {
  RunReport report;
  report.stages.push_back({"match", std::vector<double>{1}});
  report.stages.push_back({"match", std::vector<double>{3}});
  const json stages = json::parse(report_json(report)).at("time").at("stages_ms");
  EXPECT_EQ(stages, (json{{"match", {{"mean", 2}, {"median", 2}, {"p95", 3}, {"max", 3}}}}));
}

TEST(ReportJson, ErrorsAgainstGroundTruth) {
  RunReport report;
  report.ate =
      AteResult{.translation_m = {6, 5, 4, 3, 2, 1}, .T_groundtruth_estimate = {}, .pairs = {}};
  report.ate->pairs.resize(17);
  report.rpe = RpeResult{.delta_s = 1,
                         .pairs = 9,
                         .translation_m = {1, 2, 3, 4, 5, 6},
                         .rotation_deg = {7, 8, 9, 1, 2, 3}};
  const json j = json::parse(report_json(report));
  EXPECT_EQ(j.at("ate"),
            (json{{"rmse", 6},
                  {"mean", 5},
                  {"median", 4},
                  {"std", 3},
                  {"min", 2},
                  {"max", 1},
                  {"pairs", 17}}));
  EXPECT_EQ(j.at("rpe").at("delta_s"), 1);
  EXPECT_EQ(j.at("rpe").at("pairs"), 9);
  EXPECT_EQ(j.at("rpe").at("trans"),
            (json{{"rmse", 1}, {"mean", 2}, {"median", 3}, {"std", 4}, {"max", 6}}));
  EXPECT_EQ(j.at("rpe").at("rot_deg").at("rmse"), 7);
  EXPECT_EQ(j.at("rpe").at("rot_deg").at("max"), 3);
}

TEST(ReportJson, UnknownFiguresAreNull) {
  const json j = json::parse(report_json(RunReport{}));
  for (const char* path : {"/frames/ratio",
                           "/time/wall_s",
                           "/time/frame_ms/mean",
                           "/time/frame_ms/median",
                           "/time/frame_ms/p95",
                           "/time/frame_ms/max",
                           "/memory/peak_mb",
                           "/ate/rmse",
                           "/ate/mean",
                           "/ate/median",
                           "/ate/std",
                           "/ate/min",
                           "/ate/max",
                           "/ate/pairs",
                           "/rpe/delta_s",
                           "/rpe/pairs",
                           "/rpe/trans/rmse",
                           "/rpe/rot_deg/rmse",
                           "/map/points",
                           "/dynamics/mode",
                           "/objects/tracks",
                           "/objects/sightings",
                           "/objects/filled",
                           "/objects/dynamic"}) {
    EXPECT_TRUE(j.at(json::json_pointer(path)).is_null()) << path;
  }
  EXPECT_EQ(j.at("frames").at("total"), 0);
  EXPECT_EQ(j.at("keyframes"), 0);
  EXPECT_TRUE(j.at("time").at("stages_ms").empty());
  EXPECT_TRUE(j.at("warnings").empty());
}

ObjectSummary object_of(const char* class_name, std::size_t frames, std::size_t dynamic) {
  ObjectSummary object;
  object.class_name = class_name;
  object.frames = frames;
  object.filled = 1;
  object.dynamic = dynamic;
  return object;
}

TEST(ReportJson, CountsObjectsByClass) {
  RunReport report;
  report.dynamics_mode = "full";
  report.first_dynamic_s = 1.5;
  report.objects = {
      object_of("person", 10, 10), object_of("chair", 7, 2), object_of("chair", 4, 0)};
  const json j = json::parse(report_json(report));
  EXPECT_EQ(j.at("dynamics"), (json{{"mode", "full"}, {"matches_judged_by", json::object()}}));
  const json chairs = {{"tracks", 2}, {"sightings", 11}, {"filled", 2}, {"dynamic", 2}};
  const json people = {{"tracks", 1}, {"sightings", 10}, {"filled", 1}, {"dynamic", 10}};
  EXPECT_EQ(j.at("objects"),
            (json{{"tracks", 3},
                  {"sightings", 21},
                  {"filled", 3},
                  {"dynamic", 12},
                  {"first_dynamic_s", 1.5},
                  {"classes", {{"chair", chairs}, {"person", people}}}}));
}

TEST(ReportJson, AnEmptyMapHasNoBounds) {
  RunReport report;
  const PointCloud map;
  report.map = &map;
  const json j = json::parse(report_json(report)).at("map");
  EXPECT_EQ(j.at("points"), 0);
  EXPECT_TRUE(j.at("bounds_min").is_null());
}

TEST(ReportJson, SaysWhichPlacesWereLeft) {
  RunReport report;
  report.vacated = {{TrackId(4), TrackId(9), 0.75}, {TrackId(5), TrackId(8), 0.25}};
  const json j = json::parse(report_json(report)).at("map").at("vacated");
  const json of_4 = {{"track", 4}, {"found_as", 9}, {"confidence", 0.75}, {"removed", true}};
  const json of_5 = {{"track", 5}, {"found_as", 8}, {"confidence", 0.25}, {"removed", false}};
  EXPECT_EQ(j, json({of_4, of_5}));
}

TEST(ReportJson, SaysHowGoodTheMapIs) {
  const PointCloud map;
  RunReport report;
  EXPECT_TRUE(json::parse(report_json(report)).at("map").at("sa").is_null());
  EXPECT_TRUE(json::parse(report_json(report)).at("map").at("poses").is_null());
  report.map = &map;
  report.map_quality.emplace();
  report.map_quality->sa = 0.5;
  report.map_quality->ghosts = {.ratio = 0.25, .volume_l = 2, .clusters = 3};
  report.map_quality_true_poses.emplace();
  report.map_quality_true_poses->sa = 0.75;
  const json j = json::parse(report_json(report));
  EXPECT_EQ(j.at("map").at("poses"), "estimated");
  EXPECT_EQ(j.at("map").at("sa"), 0.5);
  EXPECT_EQ(j.at("map").at("completeness_ratio"), 0.5);
  EXPECT_EQ(j.at("map").at("ghost_ratio"), 0.25);
  EXPECT_EQ(j.at("map").at("ghost_clusters"), 3);
  EXPECT_TRUE(j.at("map").at("da").is_null());
  EXPECT_EQ(j.at("map_truth_poses").at("sa"), 0.75);
  EXPECT_TRUE(j.at("map_truth_poses").at("ghost_ratio").is_null());
}

TEST(ReportJson, HostileValuesStayJson) {
  RunReport report;
  report.sequence = "a\"\\\n\xff</script>";
  report.wall_s = std::numeric_limits<double>::quiet_NaN();
  const json j = json::parse(report_json(report));
  EXPECT_EQ(j.at("sequence"), "a\"\\\n\xEF\xBF\xBD</script>");
  EXPECT_TRUE(j.at("time").at("wall_s").is_null());
}

}  // namespace
}  // namespace stillmap
