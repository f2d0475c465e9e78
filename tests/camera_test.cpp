// SPDX-License-Identifier: Apache-2.0
// Cameras as a user brings them: files of other programs, wide lenses, a depth camera of its own,
// depth of an unknown unit.
#include "stillmap/geometry/camera.hpp"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/io/ply.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"

namespace stillmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CameraRun : public Cli {
 protected:
  static constexpr int kFrames = 24;

  [[nodiscard]] static CameraModel pinhole() {
    CameraModel camera{"wall", 320, 240, 300, 300, 160, 120};
    camera.depth_factor = 5000;
    return camera;
  }

  // The ATE of a run over wall/ with a camera file of this text.
  [[nodiscard]] double ate_with(const std::string& camera_file) const {
    write("wall/camera.yaml", camera_file);
    const Outcome outcome = run("run wall --out out");
    EXPECT_EQ(outcome.exit_code % 3, 0) << outcome.err;  // 3: tracking was lost
    const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
    return report["ate"]["rmse"].is_null() ? 1.0 : report["ate"]["rmse"].get<double>();
  }

  // The root mean square distance of the map's points from wall and board.
  [[nodiscard]] double map_error_m() const {
    const PointCloud map = read_ply(folder_ / "out" / "map.ply");
    EXPECT_GT(map.size(), 5000U);
    double squares = 0;
    for (const Eigen::Vector3f& p : map.positions) {
      squares += std::pow(std::min(std::abs(p.z() - 1.5F), std::abs(p.z() - 0.9F)), 2);
    }
    return std::sqrt(squares / static_cast<double>(map.size()));
  }

  // The share of the board's points in the map that lie beside the board.
  [[nodiscard]] double beside_board() const {
    const PointCloud map = read_ply(folder_ / "out" / "map.ply");
    int all = 0, beside = 0;
    for (const Eigen::Vector3f& p : map.positions) {
      if (std::abs(p.z() - 0.9F) > 0.05F) continue;
      ++all;
      beside += p.x() < -0.2F || p.x() > 0.26F ? 1 : 0;  // it reaches from -0.18 m to 0.24 m
    }
    return static_cast<double>(beside) / std::max(all, 1);
  }
};

TEST_F(CameraRun, TracksThroughAFisheye) {
  CameraModel camera = pinhole();
  camera.fx = camera.fy = 160;  // 114 degrees across
  camera.lens = LensModel::kFisheye;
  camera.k1 = -0.02;
  camera.k2 = 0.01;
  write_plane_sequence(folder_ / "wall", kFrames, camera);
  const double with = ate_with(format_camera_yaml(camera));
  EXPECT_LT(with, 0.002);
  EXPECT_LT(map_error_m(), 0.01);
  EXPECT_THAT(content("out/camera.yaml"), HasSubstr("lens: fisheye"));
  EXPECT_EQ(run("run wall --out more --load out/map.stillmap --localize-only").exit_code, 0);
  camera.lens = LensModel::kBrownConrady;
  camera.k1 = camera.k2 = 0;
  EXPECT_GT(ate_with(format_camera_yaml(camera)), 2 * with);
}

TEST_F(CameraRun, TracksThroughARationalLens) {
  CameraModel camera = pinhole();
  camera.fx = camera.fy = 190;
  camera.k1 = 0.5, camera.k2 = 0.1, camera.k4 = 0.8, camera.k5 = 0.3, camera.k6 = 0.02;
  write_plane_sequence(folder_ / "wall", kFrames, camera);
  EXPECT_LT(ate_with(format_camera_yaml(camera)), 0.002);
  EXPECT_LT(map_error_m(), 0.01);
}

TEST_F(CameraRun, RegistersDepthOfAnotherSizeAndView) {
  CameraModel camera = pinhole();
  DepthCamera depth{{"", 160, 120, 140, 141, 81, 58}, Eigen::Isometry3d::Identity()};
  depth.T_color_depth.translation() = Eigen::Vector3d(0.08, 0, 0);
  camera.depth_camera = std::make_shared<DepthCamera>(depth);
  write_plane_sequence(folder_ / "wall", kFrames, camera);
  EXPECT_LT(ate_with(format_camera_yaml(camera)), 0.003);
  EXPECT_LT(map_error_m(), 0.01);
  EXPECT_THAT(content("out/camera.yaml"), HasSubstr("depth:\n  width: 160\n"));
  EXPECT_EQ(run("evaluate residue out wall").exit_code, 0);
  EXPECT_LT(beside_board(), 0.01);
  // Taken for a camera at the same place, the depth lies beside the colors.
  depth.T_color_depth.translation() = Eigen::Vector3d::Zero();
  camera.depth_camera = std::make_shared<DepthCamera>(depth);
  (void)ate_with(format_camera_yaml(camera));
  EXPECT_GT(beside_board(), 0.05);
}

TEST_F(CameraRun, TakesTheFileOfAnotherProgram) {
  write_plane_sequence(folder_ / "wall", 12, pinhole());
  ASSERT_EQ(run("run wall --out own").exit_code, 0);
  write("cam.yml",
        "%YAML:1.0\nCamera.fx: 300\nCamera.fy: 300.\nCamera.cx: 160\nCamera.cy: 120\n"
        "Camera.width: 320\nCamera.height: 240\nDepthMapFactor: 5000.0\n");
  const Outcome outcome = run("run wall --out foreign --camera cam.yml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(content("foreign/trajectory.txt"), content("own/trajectory.txt"));
  expect_refused("run wall --out none --camera cam.yaml", "cam.yaml");
  expect_refused("run wall --out none --camera bon", "did you mean 'bonn'?");
}

TEST_F(CameraRun, FindsTheUnitOfDepthOrAsksForIt) {
  CameraModel camera = pinhole();
  camera.depth_factor = 1000;
  write_plane_sequence(folder_ / "wall", 12, camera);
  ASSERT_EQ(run("run wall --out given").exit_code, 0);
  camera.depth_factor_given = false;
  write("wall/camera.yaml", format_camera_yaml(camera));
  const Outcome found = run("run wall --out found");
  EXPECT_EQ(found.exit_code, 0);
  EXPECT_THAT(found.err,
              testing::MatchesRegex("stillmap: warning: camera 'wall' gives no depth_factor: 1000 "
                                    "[^\n]*\n"));
  EXPECT_EQ(content("found/trajectory.txt"), content("given/trajectory.txt"));
  EXPECT_THAT(content("found/camera.yaml"), HasSubstr("depth_factor: 1000"));
  EXPECT_THAT(content("found/report.json"), HasSubstr("gives no depth_factor"));

  camera.depth_factor = 3001;  // 1.5 m are 4502: as millimetres a hall, at 5000 a desk
  write_plane_sequence(folder_ / "wall", 12, camera);
  camera.depth_factor_given = false;
  write("wall/camera.yaml", format_camera_yaml(camera));
  expect_refused("run wall --out none", "give --depth-factor");
  EXPECT_EQ(run("run wall --out asked --depth-factor 3001").exit_code, 0);
  EXPECT_THAT(content("asked/camera.yaml"), HasSubstr("depth_factor: 3001"));
}

}  // namespace
}  // namespace stillmap
