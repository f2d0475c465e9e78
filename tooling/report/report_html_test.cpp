// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/report_html.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include "tooling/browser/scripts.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::Not;

Trajectory half_circle(int count) {
  Trajectory poses;
  for (int i = 0; i < count; ++i) {
    const double t = 100 + 0.1 * i;
    StampedPose pose{.stamp = {t, fmt::format("{:.6f}", t)},
                     .T_world_camera = Eigen::Isometry3d::Identity()};
    pose.T_world_camera.translation() << std::sin(0.05 * i), 0, 1 - std::cos(0.05 * i);
    poses.push_back(pose);
  }
  return poses;
}

PointCloud wall() {
  PointCloud cloud;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      cloud.positions.emplace_back(
          0.05F * static_cast<float>(x) - 1, 0.05F * static_cast<float>(y) - 0.7F, 3);
      cloud.colors.push_back({120, 90, static_cast<std::uint8_t>(6 * x)});
    }
  }
  return cloud;
}

// A report with every kind of data.
RunReport full_report(const PointCloud& map) {
  RunReport report;
  report.version = "9.8.7";
  report.sequence = "office";
  report.camera = builtin_camera("tum_fr1");
  report.config_yaml = "seed: 1\n";
  report.frames_total = 62;
  report.frames_tracked = 60;
  report.skipped.push_back({FrameId(10), {101.05, "101.05"}, "rgb/a.png: too short"});
  report.lost.push_back({101.06, "101.06"});
  report.estimate = half_circle(60);
  report.keyframes = half_circle(10);
  report.groundtruth = half_circle(60);
  report.ate = absolute_trajectory_error(*report.groundtruth, report.estimate);
  report.rpe = relative_pose_error(*report.groundtruth, report.estimate);
  report.wall_s = 3;
  report.frame_ms.assign(61, 20.0);
  report.stages.push_back({"track", std::vector<double>(61, 12.0)});
  report.stages.push_back({"map", std::vector<double>(10, 31.0)});
  report.tracked_features.assign(61, 300);
  report.peak_memory_mb = 250;
  RgbdFrame frame;
  frame.stamp = {100.5, "100.500000"};
  frame.color = ColorImage(cv::Mat3b(48, 64, cv::Vec3b(40, 60, 80)));
  FrameResult result;
  result.features = {{{10, 10}, FeatureVerdict::kStable, true},
                     {{30, 20}, FeatureVerdict::kStable, true},
                     {{50, 40}, FeatureVerdict::kStable, false}};
  ObjectState person;
  person.track = TrackId(3);
  person.class_name = "person";
  person.reason = StateReason::kDynamicClass;
  person.dynamic = true;
  person.box = {5, 6, 25, 40};
  result.objects = {person};
  result.network_mask.mat = cv::Mat1b(48, 64, std::uint8_t{0});
  result.network_mask.mat(cv::Rect(8, 8, 10, 10)).setTo(1);
  result.extended_mask.mat = result.network_mask.mat.clone();
  report.samples.emplace_back(frame, result);
  report.dynamics_mode = "full";
  ObjectSummary chair;
  chair.track = 4;
  chair.class_name = "chair";
  chair.category = "potentially dynamic";
  chair.frames = 40;
  chair.filled = 3;
  chair.dynamic = 10;
  chair.main_reason = "nobody near";
  chair.motions = {{"unknown", 2}, {"still", 28}, {"moved by someone", 10}};
  report.objects = {chair};
  report.vacated = {{TrackId(4), TrackId(9), 0.75}, {TrackId(5), TrackId(8), 0.25}};
  report.map = &map;
  report.warnings = {"depth is sparse"};
  return report;
}

// Parses the tags of a page; returns the first fault, or "" when all elements are nested and closed
// and every attribute is quoted.
std::string first_fault(std::string_view page) {
  constexpr std::array<std::string_view, 4> kVoid = {"meta", "img", "input", "!DOCTYPE"};
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != page.npos; at = page.find('<', at)) {
    std::size_t end = at + 1;
    bool quoted = false;
    for (; end < page.size() && (quoted || page[end] != '>'); ++end) {
      if (page[end] == '"') quoted = !quoted;
      if (page[end] == '<' && !quoted)
        return fmt::format("'<' inside a tag: {}", page.substr(at, 60));
    }
    if (end >= page.size()) return "a tag does not end";
    const std::string_view tag = page.substr(at + 1, end - at - 1);
    const bool closes = tag.starts_with('/');
    const std::string name(
        tag.substr(closes ? 1 : 0, tag.find_first_of(" /\n", 1) - (closes ? 1 : 0)));
    at = end + 1;
    if (closes) {
      if (open.empty() || open.back() != name) return "unexpected </" + name + ">";
      open.pop_back();
    } else if (!tag.ends_with('/') && std::find(kVoid.begin(), kVoid.end(), name) == kVoid.end()) {
      open.push_back(name);
      if (name == "script" || name == "style") at = page.find("</" + name, at);
    }
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

TEST(FirstFault, FindsFaults) {
  EXPECT_EQ(first_fault("<!DOCTYPE html><p class=\"a > b\">x<br/><img src=\"y\"></p>"), "");
  EXPECT_EQ(first_fault("<script>if (a < b) c();</script>"), "");
  EXPECT_EQ(first_fault("<p><b></p></b>"), "unexpected </p>");
  EXPECT_EQ(first_fault("<p>"), "not closed: p");
  EXPECT_NE(first_fault("<p <b>"), "");
}

TEST(ReportHtml, ShowsAllThatIsKnown) {
  const PointCloud map = wall();
  const std::string page = report_html(full_report(map));
  EXPECT_EQ(first_fault(page), "");
  for (const char* const part :
       {"<title>office - stillmap</title>",
        "9.8.7",
        "2 frames not tracked, 1 of them unreadable",
        "60 of 62",
        "96.7\u00A0%",
        "1,200",
        "250\u00A0MB",
        "20.0\u00A0ms",
        "ground truth",
        "key frames",
        "depth is sparse",
        "101.05: rgb/a.png: too short",
        "seed: 1",
        "id=\"map-view\"",
        "2 tracked, 1 found but not tracked",
        "person #3: dynamic class",
        "the network's mask",
        "extended mask",
        "<td>#4 chair</td><td>potentially dynamic</td><td>40</td><td>3</td>"
        "<td>25.0\u00A0%</td><td>nobody near</td><td>still 70.0\u00A0%, moved "
        "by someone 25.0\u00A0%</td>",
        "#4 left its place while nobody looked, and is #9 now, with a confidence of 0.75: its old "
        "place is not in the map.",
        "of 0.25: too little, both places are in the map.",
        "<td>31.0\u00A0ms</td>"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  // The legend names only what is drawn.
  for (const char* const part : {"static object", "sudden change", "filled in</span>"}) {
    EXPECT_THAT(page, Not(HasSubstr(part)));
  }
}

// What three.js could fetch, and does not: tests/report_browser_test.mjs watches it in a browser.
TEST(ReportHtml, FetchesNothing) {
  const PointCloud map = wall();
  std::string page = report_html(full_report(map));
  for (const std::string_view script : {three_min_js(), OrbitControls_js()}) {
    const std::size_t at = page.find(script);
    ASSERT_NE(at, std::string::npos);
    page.erase(at, script.size());
  }
  for (const char* const part :
       {"http:", "https:", "src=\"/", "@import", "url(", "<link", "fetch(", "XMLHttp"}) {
    EXPECT_THAT(page, Not(HasSubstr(part)));
  }
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(ReportHtml, HasItsScriptsInsideWhereTheyWereBuiltIn) {
  const PointCloud map = wall();
  const std::string page = report_html(full_report(map));
  const bool is_built_in = !three_min_js().empty();
  EXPECT_EQ(page.find("id=\"map-data\"") != std::string::npos, is_built_in);
  EXPECT_EQ(page.find("built without libjs-three") == std::string::npos, is_built_in);
  EXPECT_LT(page.size(), 1'200'000U);
}

TEST(ReportHtml, IsTheSameEachTime) {
  const PointCloud map = wall();
  EXPECT_EQ(report_html(full_report(map)), report_html(full_report(map)));
}

TEST(ReportHtml, EveryTextIsEscaped) {
  const std::string evil = "\"'><script>alert(1)</script>&{{css}}\xff";
  const PointCloud map = wall();
  RunReport report = full_report(map);
  report.version = report.sequence = report.camera.name = report.config_yaml = evil;
  report.warnings = {evil};
  report.skipped.at(0).damage = evil;
  report.skipped.at(0).stamp.text = evil;
  report.lost.at(0).text = evil;
  report.stages.at(0).name = evil;
  auto& [frame, result] = report.samples.at(0);
  frame.stamp.text = evil;
  result.objects.at(0).class_name = evil;
  report.dynamics_mode = evil;
  ObjectSummary& object = report.objects->at(0);
  object.class_name = object.category = object.main_reason = evil;
  object.motions.at(1).motion = evil;
  const std::string page = report_html(report);
  EXPECT_EQ(first_fault(page), "");
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("\xff")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;&amp;{{css}}"));
}

TEST(ReportHtml, OfNothingSaysSoInEachSection) {
  const std::string page = report_html(RunReport{});
  EXPECT_EQ(first_fault(page), "");
  for (const char* const part : {"Unnamed sequence",
                                 "No frames",
                                 "No map was made",
                                 "No frame was tracked",
                                 "There is no ground truth",
                                 "No stage was timed",
                                 "No frame was timed",
                                 "No counts of features",
                                 "Everything was taken as static",
                                 "No sample frames"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_THAT(page, Not(HasSubstr("warning</summary>")));
}

TEST(ReportHtml, SaysHowALiveRunKeptUp) {
  RunReport report;
  EXPECT_THAT(report_html(report), Not(HasSubstr("Live:")));
  report.live = LiveReport{1.0, 7, 93, {1, 2, 3, 4, 9}, {10, 20, 30}};
  EXPECT_THAT(report_html(report),
              HasSubstr("Live: 7 frames were dropped, the network looked at 93; objects were 3 "
                        "frames old in the median"));
  report.live->latency_ms.clear();
  EXPECT_THAT(report_html(report), Not(HasSubstr("after it came")));
}

TEST(ReportHtml, OfARunThatTrackedNothing) {
  RunReport report;
  report.frames_total = 5;
  const PointCloud empty;
  report.map = &empty;
  report.groundtruth = half_circle(5);
  report.lost = {{1, "1"}, {2, "2"}};
  report.samples.resize(1);
  const std::string page = report_html(report);
  EXPECT_EQ(first_fault(page), "");
  EXPECT_THAT(page, HasSubstr("No frame could be tracked"));
  EXPECT_THAT(page, HasSubstr("1 gap in tracking"));
  EXPECT_THAT(page, HasSubstr("not found again"));
  EXPECT_THAT(page, HasSubstr("The map is empty"));
  EXPECT_THAT(page, HasSubstr("fewer than three poses"));
}

TEST(ReportHtml, SaysHowGoodTheMapIsWhereTruthIsKnown) {
  const PointCloud map = wall();
  RunReport report = full_report(map);
  EXPECT_THAT(report_html(report), Not(HasSubstr("Against the true surfaces")));
  report.map_quality.emplace();
  report.map_quality->sa = 0.9761;
  report.map_quality->da = 0.5;
  report.map_quality->ghosts = {.ratio = 0.0123, .volume_l = 2, .clusters = 3};
  report.map_quality_true_poses.emplace();
  report.map_quality_true_poses->sa = 0.9812;
  const std::string page = report_html(report);
  EXPECT_EQ(first_fault(page), "");
  for (const char* text : {"Against the true surfaces",
                           "97.6 % of the surface, 1.23 % ghosts",
                           "<th>estimated poses</th><td>0.976</td><td>0.500</td>",
                           "<th>true poses</th><td>0.981</td><td>\xE2\x80\x93</td>"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST(ReportHtml, OfOnePoseWithoutGroundTruth) {
  RunReport report;
  report.frames_total = report.frames_tracked = 1;
  report.estimate = half_circle(1);
  report.keyframes = half_circle(1);
  report.frame_ms = {8};
  PointCloud map;
  map.positions = {{0, 0, 2}};
  map.colors = {{1, 2, 3}};
  report.map = &map;
  const std::string page = report_html(report);
  EXPECT_EQ(first_fault(page), "");
  EXPECT_THAT(page, HasSubstr("All frames tracked"));
  EXPECT_THAT(page, HasSubstr("There is no ground truth to compare with"));
  EXPECT_THAT(page, Not(HasSubstr("nothing to show")));
  EXPECT_THAT(page, Not(HasSubstr(">nan")));
}

TEST(ReportHtml, SaysWhyThereAreNoObjects) {
  RunReport report;
  report.dynamics_mode = "full";
  EXPECT_THAT(report_html(report), HasSubstr("No network looked for objects"));
  report.objects.emplace();
  EXPECT_THAT(report_html(report), HasSubstr("No objects were found"));
  report.objects->resize(50);
  report.objects->at(49).frames = 9;
  const std::string page = report_html(report);
  EXPECT_THAT(page, HasSubstr("and 30 more"));
  EXPECT_EQ(first_fault(page), "");
}

TEST(ReportHtml, LongListsAreCut) {
  RunReport report;
  report.warnings.assign(1000, "again");
  EXPECT_THAT(report_html(report), HasSubstr("and 800 more"));
}

}  // namespace
}  // namespace stillmap
