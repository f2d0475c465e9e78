// SPDX-License-Identifier: Apache-2.0
// `stillmap run` from outside: what it writes, that it is right, and each way in which it refuses.
#include <cmath>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

class Run : public Cli {
 protected:
  static constexpr int kFrames = 60;

  Run() { write_plane_sequence(folder_ / "wall", kFrames); }

  [[nodiscard]] std::string stamp(int frame) const {
    return fmt::format("{:.6f}", 100 + frame / 30.0);
  }
  [[nodiscard]] std::filesystem::path rgb(int frame) const {
    return folder_ / "wall" / "rgb" / (stamp(frame) + ".png");
  }

  // One clear line, exit code 2, no results.
  void expect_refused(const std::string& arguments, const std::string& part) const {
    const Outcome outcome = run("run " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.err, MatchesRegex("stillmap: [^\n]*\n")) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "trajectory.txt")) << arguments;
  }
};

TEST_F(Run, WritesARunFolderThatAgreesWithTheTruth) {
  const Outcome outcome = run("run wall --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");

  const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
  EXPECT_EQ(report["frames"]["total"], kFrames);
  EXPECT_EQ(report["frames"]["ratio"], 1.0);
  EXPECT_LT(report["ate"]["rmse"], 0.002);
  EXPECT_EQ(report["ate"]["pairs"], kFrames);
  EXPECT_GT(report["time"]["frame_ms"]["median"], 0.0);
  EXPECT_GT(report["memory"]["peak_mb"], 0.0);

  // The last frame, against the motion that the pictures were made with.
  const Trajectory trajectory = read_trajectory(folder_ / "out" / "trajectory.txt");
  ASSERT_EQ(trajectory.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(trajectory.back().stamp.text, stamp(kFrames - 1));
  const Eigen::Vector3d moved =
      trajectory.front().T_world_camera.inverse() * trajectory.back().T_world_camera.translation();
  EXPECT_LT((moved - Eigen::Vector3d(0.002, 0.001, 0) * (kFrames - 1)).norm(), 0.004);

  // The map is the wall and the board.
  const PointCloud map = read_ply(folder_ / "out" / "map.ply");
  ASSERT_GT(map.size(), 10000U);
  double squares = 0;
  for (const Eigen::Vector3f& p : map.positions) {
    squares += std::pow(std::min(std::abs(p.z() - 1.5F), std::abs(p.z() - 0.9F)), 2);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(map.size())), 0.01);
  EXPECT_THAT(content("out/report.html"), HasSubstr("</html>"));
}

TEST_F(Run, IsTheSameToTheBitForAnyThreadsSeedsAndRepeats) {
  ASSERT_EQ(run("run wall --out a --threads 1").exit_code, 0);
  ASSERT_EQ(run("run wall --out b --threads 2").exit_code, 0);
  ASSERT_EQ(run("run wall --out c --threads 4").exit_code, 0);
  for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_FALSE(content(std::string("a/") + file).empty());
    EXPECT_TRUE(content(std::string("a/") + file) == content(std::string("b/") + file)) << file;
    EXPECT_TRUE(content(std::string("a/") + file) == content(std::string("c/") + file)) << file;
  }
}

TEST_F(Run, ItsConfigurationCanBeLoadedAgain) {
  ASSERT_EQ(run("run wall --out a --set seed=7 --set cloud.voxel_size_m=0.02").exit_code, 0);
  ASSERT_EQ(run("run wall --out b --config a/config.yaml").exit_code, 0);
  EXPECT_EQ(content("a/config.yaml"), content("b/config.yaml"));
  EXPECT_TRUE(content("a/map.ply") == content("b/map.ply"));
  ASSERT_EQ(run("run wall --out c").exit_code, 0);
  EXPECT_LT(content("a/map.ply").size(), content("c/map.ply").size());  // coarser voxels, less
}

TEST_F(Run, ItsCameraCanBeUsedAgain) {
  ASSERT_EQ(run("run wall --out a").exit_code, 0);
  const CameraModel given = read_camera_yaml(folder_ / "wall" / "camera.yaml");
  const CameraModel kept = read_camera_yaml(folder_ / "a" / "camera.yaml");
  EXPECT_EQ(kept.width_px, given.width_px);
  EXPECT_EQ(kept.fx, given.fx);
  EXPECT_EQ(kept.cy, given.cy);
  EXPECT_EQ(run("run wall --camera a/camera.yaml --out b").exit_code, 0);
}

TEST_F(Run, TakesPartsOfASequence) {
  ASSERT_EQ(run("run wall --out out --frames 10:40 --stride 3").exit_code, 0);
  const Trajectory trajectory = read_trajectory(folder_ / "out" / "trajectory.txt");
  ASSERT_EQ(trajectory.size(), 10U);
  EXPECT_EQ(trajectory.front().stamp.text, stamp(10));
  EXPECT_EQ(trajectory.back().stamp.text, stamp(37));
}

TEST_F(Run, RefusesWhatIsNoSequence) {
  expect_refused("nowhere --out out", "nowhere: no such file or folder");
  write("wall/rgb.txt", "# empty\n");
  expect_refused("wall --out out", "rgb.txt");
  write("wall/rgb.txt", "2.0 rgb/a.png\n1.0 rgb/b.png\n");
  expect_refused("wall --out out", "rgb.txt:2");
  write("wall/rgb.txt", "5.0 rgb/a.png\n6.0 rgb/b.png\n");  // far from every depth stamp
  expect_refused("wall --out out", "0.02");
  write("wall/rgb.txt", "100.0 ../../etc/passwd\n");
  expect_refused("wall --out out", "rgb.txt:1");
}

TEST_F(Run, RefusesWrongArguments) {
  expect_refused("wall --out out --camera tum_fr9", "did you mean 'tum_fr1'?");
  expect_refused("wall --out out --set tracking.feature=900", "did you mean 'tracking.features'?");
  expect_refused("wall --out out --set tracking.features=many", "tracking.features");
  expect_refused("wall --out out --set mapping.lag_frames=9", "keyframe.min_gap_frames");
  expect_refused("wall --out out --dynamics ful",
                 "expected one of off, mask, ds-slam, dynaslam, paper, full, got 'ful'");
  expect_refused("wall --out out --segmenter detections:nowhere", "nowhere");
  expect_refused("wall --out out --segmenter sometimes", "--segmenter sometimes");
  for (const char* frames : {"5", "9:3", "a:b", ":-1", "4:4"}) {
    expect_refused("wall --out out --frames " + std::string(frames), "expected A:B");
  }
  expect_refused("wall --out out --frames 900:", "has only 60 frames");
  write("c.yaml", "tracking:\n  featurs: 3\n");
  expect_refused("wall --out out --config c.yaml", "c.yaml:2");
}

TEST_F(Run, ABrokenGroundTruthIsAWarning) {
  expect_refused("wall --out out --groundtruth nowhere.txt", "nowhere.txt: no such file");
  write("bad.txt", "100.0 0 0 0 0 0 0 1\n100.1 0 0\n");
  const Outcome bad = run("run wall --out out --frames 0:8 --groundtruth bad.txt");
  EXPECT_EQ(bad.exit_code, 0);
  EXPECT_THAT(bad.err, HasSubstr("warning: no ground truth: bad.txt:2: 3 columns"));
  EXPECT_THAT(content("out/report.json"), HasSubstr("bad.txt:2"));
  EXPECT_THAT(bad.out, Not(HasSubstr("ATE")));
  write("wall/groundtruth.txt", "");
  const Outcome none = run("run wall --out out --frames 0:8 --groundtruth none");
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_EQ(none.err, "");
}

// Without lists the same images are the layout `images`, whose names are stamps.
TEST_F(Run, GivesTheSameBytesForAnotherLayout) {
  ASSERT_EQ(run("run wall --out a --frames 0:20").exit_code, 0);
  std::filesystem::remove(folder_ / "wall" / "rgb.txt");
  expect_refused("wall --out b", "rgb.txt is missing");
  const Outcome forced = run("run wall --out b --frames 0:20 --format images");
  EXPECT_EQ(forced.exit_code, 0);
  EXPECT_THAT(forced.out, HasSubstr("input       images\n"));
  EXPECT_EQ(content("a/trajectory.txt"), content("b/trajectory.txt"));
  EXPECT_EQ(content("a/map.ply"), content("b/map.ply"));
}

TEST_F(Run, RefusesAnImageOfWrongSizeOrKindHalfway) {
  const std::string whole = content("wall/rgb/" + stamp(30) + ".png");
  write("wall/rgb/" + stamp(30) + ".png", encode_png(ColorImage(cv::Mat3b(100, 100))));
  expect_refused("wall --out out", "100x100 pixels, expected 320x240");
  write("wall/rgb/" + stamp(30) + ".png", whole);
  write("wall/depth/" + stamp(30) + ".png", whole);
  expect_refused("wall --out out", "expected 16-bit gray");
}

TEST_F(Run, SkipsOneDamagedImageInALongSequenceAndSaysSo) {
  std::filesystem::resize_file(rgb(30), std::filesystem::file_size(rgb(30)) / 2);
  const Outcome outcome = run("run wall --out out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              MatchesRegex("stillmap: warning: frame skipped: [^\n]*broken PNG[^\n]*\n"));
  const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
  EXPECT_EQ(report["frames"]["skipped"].size(), 1U);
  EXPECT_EQ(report["frames"]["tracked"], kFrames - 1);

  std::filesystem::remove_all(folder_ / "out");
  std::filesystem::remove(rgb(31));  // a second one in 60 is no accident any more
  const Outcome refused = run("run wall --out out");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("no such file"));
  EXPECT_THAT(refused.err, HasSubstr("2 damaged so far"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "trajectory.txt"));
}

TEST_F(Run, RefusesAFolderThatCannotBeWritten) {
  write("file", "");
  expect_refused("wall --out file", "file: the folder cannot be made");
  expect_refused("wall --out /proc/results", "/proc/results");
  expect_refused("wall --out /dev/full/results", "/dev/full/results");
}

TEST_F(Run, AFullDiskIsOneLineAndLeavesTheOldResultsWhole) {
  std::filesystem::create_directories(folder_ / "out");
  write("out/trajectory.txt", "old");
  write("out/objects.jsonl", "old");
  write("out/notes.txt", "foreign");
  // No file beyond 64 KiB: the map does not fit, the trajectory does.
  const Outcome outcome =
      run("config > /dev/null; ulimit -f 128; trap '' XFSZ; '" STILLMAP_BINARY_DIR
          "/bin/stillmap' run wall --out out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, MatchesRegex("stillmap: [^\n]*out/map.ply[^\n]*\n"));
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out")) {
    names.insert(entry.path().filename().string());
  }
  EXPECT_EQ(names, (std::set<std::string>{"notes.txt", "objects.jsonl", "trajectory.txt"}));
  EXPECT_EQ(content("out/trajectory.txt") + content("out/objects.jsonl"), "oldold");
  // With room, all of it is new, and what this run has not is gone.
  ASSERT_EQ(run("run wall --out out").exit_code, 0);
  EXPECT_GT(content("out/trajectory.txt").size(), 1000U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "objects.jsonl"));
  EXPECT_EQ(content("out/notes.txt"), "foreign");
}

TEST_F(Run, NeverOverwritesItsInput) {
  const std::string camera = content("wall/camera.yaml");
  std::filesystem::create_directories(folder_ / "out");
  for (const char* name : {"config.yaml", "live.jsonl", "map.stillmap", "trajectory.txt"}) {
    write(std::string("out/") + name, content("wall/groundtruth.txt"));
  }
  std::filesystem::copy(folder_ / "wall/camera.yaml", folder_ / "out/camera.yaml");
  for (const char* arguments : {"wall --out wall",
                                "wall --out wall/rgb/x",
                                "wall --out wall/depth",
                                "wall --out out/../wall/./",
                                "wall --out x --write-objects wall/truth",
                                "wall --out out --camera out/camera.yaml",
                                "wall --out out --groundtruth out/trajectory.txt"}) {
    const Outcome outcome = run(std::string("run ") + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.err, MatchesRegex("stillmap: [^\n]*would be overwritten[^\n]*\n"));
  }
  EXPECT_EQ(content("wall/camera.yaml"), camera);
  EXPECT_THAT(run("run wall --out x --write-objects x/").err, HasSubstr("is the folder of --out"));
  write("wall/camera.yaml", "");  // nor does a file come into being that the next run would read
  std::filesystem::remove(folder_ / "wall/camera.yaml");
  EXPECT_THAT(run("run wall --out wall --camera out/camera.yaml").err,
              HasSubstr("would be overwritten"));
}

TEST_F(Run, CountsJpegsThatLackNoPixel) {
  std::string list;
  for (int i = 0; i < 10; ++i) {
    const ColorImage color = read_color(rgb(i));
    const std::vector<std::uint8_t> bytes = encode_jpeg(color, 95);
    const bool odd = i % 3 == 1;
    write("wall/rgb/" + stamp(i) + ".png", std::string(bytes.begin(), bytes.end() - (odd ? 2 : 0)));
  }
  const Outcome outcome = run("run wall --out out --frames 0:10 --segmenter none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              MatchesRegex("stillmap: warning: 3 images are not quite in order, "
                           "all pixels are there; the first: [^\n]*" +
                           stamp(1) + "[^\n]*Premature end[^\n]*\n"));
  const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
  EXPECT_EQ(report["warnings"].size(), 1U);
  EXPECT_EQ(report["frames"]["tracked"], 10);
}

TEST_F(Run, SaysWhyNothingWasTracked) {
  for (int i = 0; i < 3; ++i) {
    write("wall/depth/" + stamp(i) + ".png",
          encode_depth_png(DepthImage(cv::Mat1f::zeros(240, 320)), 5000));
    write("wall/depth/" + stamp(i + 3) + ".png",
          encode_depth_png(DepthImage(cv::Mat1f(240, 320, 12.5F)), 5000));
    write("wall/rgb/" + stamp(i + 6) + ".png", encode_png(ColorImage(cv::Mat3b::zeros(240, 320))));
  }
  const Outcome empty = run("run wall --out out --frames 0:3");
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_THAT(empty.err, HasSubstr("the depth images of 3 of the 3 frames measure nothing"));
  EXPECT_THAT(run("run wall --out out --frames 3:6").err,
              HasSubstr("the depth of 3 of the 3 frames is beyond 10 m nearly everywhere"));
  EXPECT_THAT(run("run wall --out out --frames 6:9").err,
              HasSubstr("3 of the 3 frames have hardly any corners"));
  EXPECT_EQ(run("run wall --out out --frames 9:12").err, "");
}

// Nanoseconds, where the option says that they are seconds.
TEST_F(Run, NamesAbsurdStamps) {
  std::string rgb_list, depth_list;
  for (int i = 0; i < 4; ++i) {
    const std::string absurd = fmt::format("{}", 100000000 * (i + 1));
    rgb_list += absurd + " rgb/" + stamp(i) + ".png\n";
    depth_list += absurd + " depth/" + stamp(i) + ".png\n";
  }
  write("wall/rgb.txt", rgb_list);
  write("wall/depth.txt", depth_list);
  const Outcome outcome = run("run wall --out out --stamps s");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("the frames are 1e+08 s apart on average"));
  const Outcome live = run("run wall --out live --live --speed 100 --stamps s");
  EXPECT_EQ(live.exit_code, 0);
  EXPECT_THAT(live.err, HasSubstr("299999997 s in all were not waited for"));
  EXPECT_THAT(content("out/report.html"), HasSubstr("of path<"));
}

TEST_F(Run, LostForGoodIsExitCodeThree) {
  for (int i = 40; i < kFrames; ++i) {
    write("wall/rgb/" + stamp(i) + ".png", encode_png(ColorImage(cv::Mat3b::zeros(240, 320))));
  }
  const Outcome outcome = run("run wall --out out");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(read_trajectory(folder_ / "out" / "trajectory.txt").size(), 40U);
  const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
  EXPECT_EQ(report["frames"]["lost"].size(), 20U);
}

TEST_F(Run, FindsItsPlaceAgainAfterTheCameraWasCovered) {
  for (int i = 20; i < 30; ++i) {
    write("wall/rgb/" + stamp(i) + ".png", encode_png(ColorImage(cv::Mat3b::zeros(240, 320))));
  }
  ASSERT_EQ(run("run wall --out out").exit_code, 0);
  const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
  EXPECT_EQ(report["frames"]["tracked"], kFrames - 10);
  EXPECT_LT(report["ate"]["rmse"], 0.004);
}

// In the dark from frame 30 to 59; frame k then shows what frame k - 60 did.
TEST_F(Run, FindsItsPlaceAgainWhereItWentInTheDark) {
  constexpr int kAll = 90, kDark = 30, kLight = 60, kBack = 60;
  write_plane_sequence(folder_ / "wall", kAll);
  std::istringstream lines(content("wall/groundtruth.txt"));
  std::vector<std::string> poses;
  for (std::string line; std::getline(lines, line);) poses.push_back(line.substr(line.find(' ')));
  std::string truth;
  for (int i = 0; i < kAll; ++i) {
    const std::string color = "wall/rgb/" + stamp(i) + ".png",
                      depth = "wall/depth/" + stamp(i) + ".png";
    if (i >= kLight) {
      write(color, content("wall/rgb/" + stamp(i - kBack) + ".png"));
      write(depth, content("wall/depth/" + stamp(i - kBack) + ".png"));
    } else if (i >= kDark) {
      write(color, encode_png(ColorImage(cv::Mat3b::zeros(240, 320))));
      write(depth, encode_depth_png(DepthImage(cv::Mat1f::zeros(240, 320)), 5000));
    }
    truth += stamp(i) + poses.at(static_cast<std::size_t>(i < kLight ? i : i - kBack)) + "\n";
  }
  write("wall/groundtruth.txt", truth);
  const Outcome outcome = run("run wall --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("no pose     30 frames from " + stamp(kDark)));
  const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
  EXPECT_LT(report["ate"]["rmse"], 0.006);
  const nlohmann::json gaps = report["tracking"]["gaps"];
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0]["first_lost"], stamp(kDark));
  EXPECT_EQ(gaps[0]["frames"], kLight - kDark);
  EXPECT_NEAR(gaps[0]["seconds"], 1.0, 1e-5);
  EXPECT_EQ(gaps[0]["found_again"], true);
  EXPECT_EQ(gaps[0]["found_at"], stamp(kLight));
  // From frame 29 to what frame 0 shows: 29 steps of 2 mm and 1 mm.
  EXPECT_NEAR(gaps[0]["moved_m"], 29 * std::hypot(0.002, 0.001), 0.008);
  std::set<std::string> tracked;
  for (const StampedPose& pose : read_trajectory(folder_ / "out" / "trajectory.txt")) {
    tracked.insert(pose.stamp.text);
  }
  for (int i = 0; i < kAll; ++i) {
    EXPECT_EQ(tracked.contains(stamp(i)), i < kDark || i >= kLight) << i;
  }
}

}  // namespace
}  // namespace stillmap
