// SPDX-License-Identifier: Apache-2.0
// What is said and shown of maps: `stillmap evaluate map`, `evaluate residue`, `view`, and the
// figures of `run` where a sequence comes with its true surfaces.
#include <algorithm>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

// Squares of 1 m, 2 cm apart, at depth z.
PointCloud square(double z) {
  PointCloud cloud;
  for (int i = 0; i < 50; ++i) {
    for (int k = 0; k < 50; ++k) {
      cloud.positions.push_back(Eigen::Vector3d(0.02 * i + 0.01, 0.02 * k + 0.01, z).cast<float>());
      cloud.colors.push_back({100, 120, 140});
    }
  }
  return cloud;
}

PointCloud operator+(PointCloud a, const PointCloud& b) {
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.colors.insert(a.colors.end(), b.colors.begin(), b.colors.end());
  return a;
}

class MapCommands : public Cli {
 protected:
  // The map: the true wall, and half a metre before it as much of what moved.
  MapCommands() {
    write("static.ply", encode_ply(square(2.01)));
    write("dynamic.ply", encode_ply(square(1.51)));
    write("map.ply", encode_ply(square(2.01) + square(1.51)));
  }

  [[nodiscard]] nlohmann::json figures(const std::string& arguments) const {
    const Outcome outcome = run(arguments + " --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
};

TEST_F(MapCommands, MapAgainstTruth) {
  const nlohmann::json map =
      figures("evaluate map map.ply --static static.ply --dynamic dynamic.ply")["map"];
  EXPECT_EQ(map["points"], 5000);
  EXPECT_EQ(map["sa"], 1.0);
  EXPECT_EQ(map["completeness_ratio"], 1.0);
  EXPECT_EQ(map["da"], 0.0);
  EXPECT_EQ(map["ha"], 0.0);
  EXPECT_NEAR(map["accuracy_m"], 0.25, 1e-6);
  EXPECT_EQ(map["completeness_m"], 0.0);
  EXPECT_EQ(map["ghost_ratio"], 0.5);
  EXPECT_NEAR(map["ghost_volume_l"], 2500 * 0.008, 1e-9);
  EXPECT_EQ(map["ghost_clusters"], 1);
  EXPECT_EQ(map["off_ratio_5cm"], 0.5);
  const Outcome table = run("evaluate map map.ply --static static.ply --dynamic dynamic.ply");
  EXPECT_THAT(table.out, HasSubstr("50.0000 %"));

  const nlohmann::json without = figures("evaluate map map.ply --static static.ply")["map"];
  EXPECT_TRUE(without["da"].is_null());
  EXPECT_TRUE(without["ghost_clusters"].is_null());
}

TEST_F(MapCommands, TrajectoriesSayWhereTheMapLies) {
  const Eigen::Isometry3d T_truth_world = make_pose(so3_exp({0.4, -1, 2}), {5, 6, -7});
  Trajectory estimate, truth;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Isometry3d T_world_camera =
        make_pose(so3_exp({0, 0, 0.1 * i}), {0.3 * i, 0.1 * i * i, std::sin(i)});
    estimate.push_back({{1.0 + i, fmt::format("{}.0", 1 + i)}, T_world_camera});
    truth.push_back({{1.001 + i, fmt::format("{}.001", 1 + i)}, T_truth_world * T_world_camera});
  }
  write("est.txt", format_trajectory(estimate));
  write("gt.txt", format_trajectory(truth));
  PointCloud map = square(2.01) + square(1.51);
  for (Eigen::Vector3f& p : map.positions) {
    p = (T_truth_world.inverse() * p.cast<double>()).cast<float>();
  }
  write("moved.ply", encode_ply(map));
  const nlohmann::json found = figures(
      "evaluate map moved.ply --static static.ply --dynamic dynamic.ply --groundtruth gt.txt "
      "--trajectory est.txt")["map"];
  EXPECT_EQ(found["sa"], 1.0);
  EXPECT_EQ(found["da"], 0.0);
  EXPECT_NEAR(found["accuracy_m"], 0.25, 1e-3);

  for (StampedPose& pose : truth) pose.stamp = {pose.stamp.seconds + 100, pose.stamp.text + "9"};
  write("other.txt", "900 0 0 0 0 0 0 1\n901 0 0 0 0 0 0 1\n902 0 0 0 0 0 0 1\n");
  expect_refused(
      "evaluate map moved.ply --static static.ply --groundtruth other.txt --trajectory est.txt",
      "are both of the same sequence?");
  expect_refused("evaluate map moved.ply --static static.ply --groundtruth gt.txt", "--trajectory");
}

TEST_F(MapCommands, BadMapsAreRefused) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n{}";
  write("nan.ply", fmt::format(fmt::runtime(header), 1, "nan 0 0\n"));
  write("far.ply", fmt::format(fmt::runtime(header), 1, "0 0 1e9\n"));
  write("empty.ply", fmt::format(fmt::runtime(header), 0, ""));
  write("absurd.ply", fmt::format(fmt::runtime(header), "999999999999999", "0 0 0\n"));
  write("short.ply", content("map.ply").substr(0, 1000));
  write("picture.ply", "\x89PNG\r\n");
  const std::string truth = " --static static.ply --dynamic dynamic.ply";
  expect_refused("evaluate map nan.ply" + truth, "nan.ply: the position of vertex 0");
  expect_refused("evaluate map far.ply" + truth, "far.ply: point 0 is at 0 0 1e+09");
  expect_refused("evaluate map absurd.ply" + truth, "absurd.ply: 999999999999999 vertices");
  expect_refused("evaluate map short.ply" + truth, "short.ply");
  expect_refused("evaluate map picture.ply" + truth, "picture.ply");
  expect_refused("evaluate map nowhere.ply" + truth, "nowhere.ply");
  expect_refused("evaluate map ." + truth, "");
  expect_refused("evaluate map map.ply --static empty.ply", "empty.ply: no points");
  expect_refused("evaluate map map.ply", "--static");
  expect_refused("view empty.ply --out a.png", "empty.ply: no points");
  expect_refused("view nan.ply --out a.png", "nan.ply");
  // A map without points is a map: nothing is in it.
  const nlohmann::json map = figures("evaluate map empty.ply" + truth)["map"];
  EXPECT_EQ(map["sa"], 0.0);
  EXPECT_EQ(map["da"], 1.0);
  EXPECT_TRUE(map["accuracy_m"].is_null());
  EXPECT_TRUE(map["ghost_ratio"].is_null());
}

TEST_F(MapCommands, ViewsAreTiled) {
  ASSERT_EQ(run("view map.ply --out all.png --size 160x120").exit_code, 0);
  EXPECT_EQ(read_color(folder_ / "all.png").mat.size(), cv::Size(3 * 160 + 24, 120 + 26));
  ASSERT_EQ(run("view map.ply --out all.jpg --size 160x120").exit_code, 0);
  EXPECT_EQ(content("all.jpg").substr(0, 2), "\xFF\xD8");
  EXPECT_EQ(read_color(folder_ / "all.jpg").mat.size(), cv::Size(3 * 160 + 24, 120 + 26));
  const Outcome two = run(
      "view map.ply static.ply --from front --out two.png --size 160x120 --name both --name wall");
  ASSERT_EQ(two.exit_code, 0) << two.err;
  const cv::Mat3b picture = read_color(folder_ / "two.png").mat;
  ASSERT_EQ(picture.size(), cv::Size(2 * 160 + 12, 120 + 26));
  EXPECT_NE(picture(86, 80), cv::Vec3b(255, 255, 255));  // something is to be seen
  EXPECT_EQ(run("view map.ply --up=-z --from top --out up.png").exit_code, 0);
  EXPECT_NE(content("up.png"), "");
  expect_refused("view map.ply --up w --out a.png", "--up");
  expect_refused("view map.ply --from below --out a.png", "--from below");
  expect_refused("view map.ply --size 10x10 --out a.png", "--size 10x10");
  expect_refused("view map.ply", "--out");
  expect_refused("view map.ply --out no/such/folder/a.png", "no/such/folder");
}

TEST_F(MapCommands, SurfacesAreDrawnWithoutGaps) {
  // A square of points, 1 cm apart in its left half and 8 cm in the right one.
  PointCloud wall;
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 100; ++column) {
      if (column >= 50 && (row % 8 != 0 || column % 8 != 0)) continue;
      wall.positions.emplace_back(
          0.01F * static_cast<float>(column), 0.01F * static_cast<float>(row), 1.0F);
      wall.colors.push_back({200, 100, 50});
      wall.normals.emplace_back(0.0F, 0.0F, -1.0F);
    }
  }
  write("wall.ply", encode_ply(wall));
  const auto empty_share = [&](const std::string& options) {
    EXPECT_EQ(
        run("view wall.ply --up=z --from top --size 640x480 --out wall.png" + options).exit_code,
        0);
    const cv::Mat3b middle = read_color(folder_ / "wall.png").mat(cv::Rect(240, 180, 160, 120));
    const auto empty = std::count(middle.begin(), middle.end(), cv::Vec3b(255, 255, 255));
    return static_cast<double>(empty) / static_cast<double>(middle.total());
  };
  EXPECT_GT(empty_share(""), 0.1);
  EXPECT_EQ(empty_share(" --surface --mesh-cell 0.06"), 0.0);
  expect_refused("view static.ply --surface --out a.png",
                 "static.ply: --surface needs points with normals");
  expect_refused("view wall.ply --mesh-cell 0.1 --out a.png", "--surface");
  expect_refused("view wall.ply --surface --mesh-cell 0 --out a.png", "--mesh-cell");
}

// ---- with runs ----

class MapOfRun : public MapCommands {
 protected:
  static constexpr int kFrames = 60;
  MapOfRun() { write_plane_sequence(folder_ / "wall", kFrames); }

  // A first run makes the sequence's true surfaces: what it maps, in the frame of ground truth.
  void add_truth() {
    ASSERT_EQ(run("run wall --out first --poses truth").exit_code, 0);
    const Trajectory truth = read_trajectory(folder_ / "wall" / "groundtruth.txt");
    PointCloud map = read_ply(folder_ / "first" / "map.ply");
    const Trajectory estimate = read_trajectory(folder_ / "first" / "trajectory.txt");
    const Eigen::Isometry3d T_truth_world =
        truth.front().T_world_camera * estimate.front().T_world_camera.inverse();
    for (Eigen::Vector3f& p : map.positions) {
      p = (T_truth_world * p.cast<double>()).cast<float>();
    }
    std::filesystem::create_directories(folder_ / "wall" / "truth");
    write("wall/truth/static_map.ply", encode_ply(map));
  }

  [[nodiscard]] nlohmann::json report(const std::string& folder) const {
    return nlohmann::json::parse(content(folder + "/report.json"));
  }
};

TEST_F(MapOfRun, ReportHasItsFigures) {
  add_truth();
  EXPECT_TRUE(report("first")["map"]["sa"].is_null());  // there was no truth yet
  EXPECT_EQ(report("first")["map"]["poses"], "truth");
  ASSERT_EQ(run("run wall --out out").exit_code, 0);
  const nlohmann::json map = report("out")["map"];
  EXPECT_EQ(map["poses"], "estimated");
  EXPECT_GT(map["sa"], 0.99);
  EXPECT_LT(map["accuracy_m"], 0.01);
  EXPECT_TRUE(map["da"].is_null());
  EXPECT_GT(report("out")["map_truth_poses"]["sa"], 0.99);
  EXPECT_THAT(content("out/report.html"), HasSubstr("Against the true surfaces"));

  // The same from outside.
  const nlohmann::json again = figures(
      "evaluate map out/map.ply --static wall/truth/static_map.ply --groundtruth "
      "wall/groundtruth.txt --trajectory out/trajectory.txt")["map"];
  for (const char* key : {"sa", "accuracy_m", "completeness_m", "off_ratio_5cm"}) {
    EXPECT_NEAR(again[key], map[key], 1e-3) << key;
  }
}

TEST_F(MapOfRun, PosesOfTruthMoveTheMapButNotTheTrajectory) {
  ASSERT_EQ(run("run wall --out a").exit_code, 0);
  // Ground truth that goes twice as far, so that the map at its poses is another one.
  Trajectory far = read_trajectory(folder_ / "wall" / "groundtruth.txt");
  for (StampedPose& pose : far) pose.T_world_camera.translation() *= 2;
  write("far.txt", format_trajectory(far));
  const Outcome outcome = run("run wall --out b --poses truth --groundtruth far.txt");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(content("a/trajectory.txt"), content("b/trajectory.txt"));
  EXPECT_EQ(content("a/keyframes.txt"), content("b/keyframes.txt"));
  EXPECT_NE(content("a/map.ply"), content("b/map.ply"));
  EXPECT_EQ(report("b")["map"]["poses"], "truth");
  const auto width = [&](const char* folder) {
    const nlohmann::json map = report(folder)["map"];
    return map["bounds_max"][0].get<double>() - map["bounds_min"][0].get<double>();
  };
  // 2 mm a frame: key frames lie up to 0.118 m apart, and now as much again.
  EXPECT_GT(width("b"), width("a") + 0.05);
  EXPECT_LT(width("b"), width("a") + 0.13);
}

TEST_F(MapOfRun, PosesOfTruthNeedTruth) {
  std::filesystem::remove(folder_ / "wall" / "groundtruth.txt");
  expect_refused("run wall --out out --poses truth", "has no ground truth");
  expect_refused("run wall --out out --poses wrong", "--poses");
  std::filesystem::create_directories(folder_ / "wall" / "truth");
  write("wall/truth/static_map.ply", "no map");
  EXPECT_EQ(run("run wall --out out").exit_code, 0);  // without trajectory it is of no use
  write_plane_sequence(folder_ / "wall", kFrames);
  expect_refused("run wall --out out2", "static_map.ply");
}

TEST_F(MapOfRun, ResidueFindsWhatIsNotThere) {
  ASSERT_EQ(run("run wall --out out").exit_code, 0);
  const nlohmann::json clean = figures("evaluate residue out wall")["residue"];
  const double points = clean["points"];
  EXPECT_EQ(clean["frames"], kFrames);
  EXPECT_LT(clean["ratio"], 0.02);

  // A hundred points in the air before the wall.
  PointCloud map = read_ply(folder_ / "out" / "map.ply");
  for (int i = 0; i < 100; ++i) {
    map.positions.emplace_back(0.001F * static_cast<float>(i), 0.1F, 0.6F);
    map.colors.push_back({});
    if (!map.labels.empty()) map.labels.push_back(0);
    if (!map.normals.empty()) map.normals.emplace_back(0.0F, 0.0F, 1.0F);
  }
  write("out/map.ply", encode_ply(map));
  for (const char* options : {"", " --groundtruth wall/groundtruth.txt"}) {
    const nlohmann::json found =
        figures(std::string("evaluate residue out wall") + options)["residue"];
    EXPECT_EQ(found["points"], points + 100);
    EXPECT_NEAR(found["seen_through"].get<double>(), clean["seen_through"].get<double>() + 100, 3);
    EXPECT_NEAR(found["by_noise"].get<double>(), clean["by_noise"].get<double>(), 3);
  }
  EXPECT_THAT(run("evaluate residue out wall").out,
              AllOf(HasSubstr("of 60 frames"), HasSubstr("noise floor")));
}

TEST_F(MapOfRun, ResidueRefusesOtherSequences) {
  ASSERT_EQ(run("run wall --out out").exit_code, 0);
  write_plane_sequence(folder_ / "short", 20);
  expect_refused("evaluate residue out short", "is the run of this sequence?");
  expect_refused("evaluate residue nowhere wall", "nowhere");
  expect_refused("evaluate residue out nowhere", "nowhere");
  std::filesystem::remove(folder_ / "out" / "map.ply");
  expect_refused("evaluate residue out wall", "map.ply");
}

}  // namespace
}  // namespace stillmap
