// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_io.hpp"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kGood = "width: 320\nheight: 240\nfx: 250.5\nfy: 251\ncx: 160\ncy: 1.2e2\n";

CameraModel read_yaml(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "camera.yaml", text);
  return read_camera_yaml(folder.path() / "camera.yaml");
}

std::string yaml_error(const std::string& text) {
  return error_of([&] { (void)read_yaml(text); });
}

CameraModel read_truth(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "objects.json", text);
  return read_truth_camera(folder.path() / "objects.json");
}

TEST(ReadCameraYaml, ReadsTheKeysAndDefaultsTheRest) {
  const CameraModel camera = read_yaml(std::string(kGood) + "k2: -0.25\n");
  EXPECT_EQ(camera.name, "camera");
  EXPECT_EQ(camera.width_px, 320);
  EXPECT_EQ(camera.height_px, 240);
  EXPECT_EQ(camera.fx, 250.5);
  EXPECT_EQ(camera.fy, 251.0);
  EXPECT_EQ(camera.cx, 160.0);
  EXPECT_EQ(camera.cy, 120.0);
  EXPECT_EQ(camera.k1, 0.0);
  EXPECT_EQ(camera.k2, -0.25);
  EXPECT_EQ(camera.depth_factor, 5000.0);
}

TEST(ReadCameraYaml, GivesBackWhatFormatWrote) {
  for (const std::string& name : builtin_camera_names()) {
    CameraModel camera = builtin_camera(name);
    camera.name = "a \"quoted\": name # of " + name;
    camera.fx += 1.0 / 3.0;
    const CameraModel read_back = read_yaml(format_camera_yaml(camera));
    EXPECT_EQ(read_back.name, camera.name);
    EXPECT_EQ(read_back.width_px, camera.width_px);
    EXPECT_EQ(read_back.height_px, camera.height_px);
    for (double CameraModel::*member : {&CameraModel::fx,
                                        &CameraModel::fy,
                                        &CameraModel::cx,
                                        &CameraModel::cy,
                                        &CameraModel::k1,
                                        &CameraModel::k2,
                                        &CameraModel::p1,
                                        &CameraModel::p2,
                                        &CameraModel::k3,
                                        &CameraModel::depth_factor}) {
      EXPECT_EQ(read_back.*member, camera.*member);
    }
  }
}

TEST(ReadCameraYaml, GivesBackWideLensesAndTheDepthCamera) {
  CameraModel camera = builtin_camera("tum_fr3");
  camera.k4 = 1.0 / 3;
  camera.k6 = -1.0 / 7;
  DepthCamera depth;
  depth.camera.width_px = 512;
  depth.camera.height_px = 424;
  depth.camera.fx = depth.camera.fy = 366.1;
  depth.camera.k1 = 0.1;
  depth.camera.lens = LensModel::kFisheye;
  depth.T_color_depth = Eigen::Translation3d(0.052, -1e-3, 1.0 / 3) *
                        Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
  camera.depth_camera = std::make_shared<DepthCamera>(depth);
  const CameraModel read_back = read_yaml(format_camera_yaml(camera));
  EXPECT_TRUE(same_lens(read_back, camera));
  ASSERT_NE(read_back.depth_camera, nullptr);
  EXPECT_TRUE(same_lens(read_back.depth_camera->camera, depth.camera));
  EXPECT_EQ(read_back.depth_camera->T_color_depth.matrix(), depth.T_color_depth.matrix());
  EXPECT_EQ(format_camera_yaml(read_back), format_camera_yaml(camera));
}

TEST(ReadCameraYaml, ReadsTheDepthCamera) {
  const std::string depth = std::string(kGood) +
                            "depth:\n  width: 160\n  height: 120\n  fx: 125\n  fy: 126\n"
                            "  cx: 80\n  cy: 60\n  k1: 0.5\n";
  EXPECT_TRUE(
      read_yaml(depth).depth_camera->T_color_depth.isApprox(Eigen::Isometry3d::Identity(), 0));
  // A quarter turn about z takes x to y.
  const CameraModel turned = read_yaml(depth +
                                       "  rotation: [0, 0, 0.70710678, 0.70710678]\n"
                                       "  translation: [0.025, 0, -0.001]\n");
  const Eigen::Vector3d p = turned.depth_camera->T_color_depth * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((p - Eigen::Vector3d(0.025, 1, -0.001)).norm(), 1e-9);
  EXPECT_EQ(turned.depth_camera->camera.k1, 0.5);
  const CameraModel by_rows = read_yaml(depth + "  rotation: [0, -1, 0, 1, 0, 0, 0, 0, 1]\n");
  EXPECT_LT(
      (by_rows.depth_camera->T_color_depth * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 0))
          .norm(),
      1e-12);
  EXPECT_THAT(yaml_error(depth + "  rotation: [0, 0, 0, 2]\n"),
              AllOf(HasSubstr("camera.yaml:15"), HasSubstr("quaternion")));
  EXPECT_THAT(yaml_error(depth + "  rotation: [1, 0, 0, 0, 1, 0, 0, 0, -1]\n"),
              HasSubstr("depth.rotation"));
  EXPECT_THAT(yaml_error(depth + "  translation: [1, 2]\n"), HasSubstr("2 numbers, expected 3"));
  EXPECT_THAT(yaml_error(depth + "  fz: 2\n"), HasSubstr("camera.yaml:15: unknown key 'depth.fz'"));
  EXPECT_THAT(yaml_error(std::string(kGood) + "depth:\n  width: 160\n"),
              HasSubstr("missing depth.height, depth.fx, depth.fy, depth.cx, depth.cy"));
}

TEST(ReadCameraYaml, SaysWhetherADepthFactorWasGiven) {
  EXPECT_FALSE(read_yaml(kGood).depth_factor_given);
  EXPECT_TRUE(read_yaml(std::string(kGood) + "depth_factor: 1000\n").depth_factor_given);
}

TEST(ReadCameraYaml, ReadsTheLens) {
  const CameraModel fish = read_yaml(std::string(kGood) + "lens: fisheye\nk4: 0.1\n");
  EXPECT_EQ(fish.lens, LensModel::kFisheye);
  EXPECT_EQ(fish.k4, 0.1);
  EXPECT_THAT(yaml_error(std::string(kGood) + "lens: fish\n"), HasSubstr("camera.yaml:7: lens"));
  EXPECT_THAT(yaml_error(std::string(kGood) + "lens: fisheye\np1: 0.1\n"), HasSubstr("k1 to k4"));
}

TEST(CameraByName, TakesAnyFileThatIsThere) {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const char* name : {"cam.yml", "cam.yaml", "cam.json", "cam"}) {
    write_file_atomically(folder.path() / name, kGood);
    EXPECT_EQ(camera_by_name(name).fx, 250.5) << name;
  }
  write_file_atomically(folder.path() / "bonn", kGood);
  EXPECT_EQ(camera_by_name("bonn").fx, builtin_camera("bonn").fx);
  EXPECT_THAT(error_of([] { (void)camera_by_name("none.yml"); }), HasSubstr("none.yml"));
  EXPECT_THAT(error_of([] { (void)camera_by_name("bon"); }), HasSubstr("did you mean 'bonn'?"));
  std::filesystem::current_path(before);
}

TEST(ReadCameraYaml, RefusesAnUnknownKeyWithItsLineAndTheNearest) {
  EXPECT_THAT(yaml_error(std::string(kGood) + "depth_facto: 1000\n"),
              AllOf(HasSubstr("camera.yaml:7"), HasSubstr("did you mean 'depth_factor'?")));
  EXPECT_THAT(yaml_error(std::string(kGood) + "k7: 1\n"),
              AllOf(HasSubstr("unknown key 'k7': known: "), HasSubstr("k1, k2, p1, p2")));
}

TEST(ReadCameraYaml, RefusesValuesThatCannotBe) {
  const std::string good = kGood;
  EXPECT_THAT(yaml_error(good + "k1: .nan\n"), HasSubstr("camera.yaml:7: k1 is '.nan'"));
  EXPECT_THAT(yaml_error(good + "k1: inf\n"), HasSubstr("finite"));
  EXPECT_THAT(yaml_error(good + "k1: 1,5\n"), HasSubstr("finite number"));
  EXPECT_THAT(yaml_error(good + "k1: [1]\n"), HasSubstr("one value for each key"));
  EXPECT_THAT(yaml_error(good + "k1:\n"), HasSubstr("camera.yaml:7: expected one value"));
  EXPECT_THAT(yaml_error(good + "depth_factor: 0\n"), HasSubstr("positive"));
  EXPECT_THAT(yaml_error(good + "fx: 3\n"), HasSubstr("fx is given twice"));
  EXPECT_THAT(yaml_error("width: 0\nheight: 2\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"), HasSubstr("width"));
  EXPECT_THAT(yaml_error("width: 2\nheight: 9000\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"),
              HasSubstr("height is 9000, expected 1 to 8192"));
  EXPECT_THAT(yaml_error("width: 2.5\nheight: 2\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"),
              HasSubstr("whole number"));
  EXPECT_THAT(yaml_error("width: 2\nheight: 2\nfx: -1\nfy: 1\ncx: 1\ncy: 1\n"),
              HasSubstr("fx is -1, expected a positive number"));
}

TEST(ReadCameraYaml, RefusesWhatIsNoCamera) {
  EXPECT_THAT(yaml_error("width: 320\nfx: 1\n"), HasSubstr("missing height, fy, cx, cy"));
  EXPECT_THAT(yaml_error(""), HasSubstr("not a camera"));
  EXPECT_THAT(yaml_error("- 1\n- 2\n"), HasSubstr("not a camera"));
  EXPECT_THAT(yaml_error("fx: 1\nfy: [1, 2\n"),
              AllOf(HasSubstr("camera.yaml:"), HasSubstr("YAML")));
  EXPECT_THAT(yaml_error(std::string(100000, '[')), HasSubstr("camera.yaml"));
  // The library of YAML takes a zero for an escape character and quotes the line end after it.
  EXPECT_THAT(yaml_error(std::string("fx: 1\0\n", 7)), HasSubstr("not YAML"));
}

TEST(ReadTruthCamera, ReadsTheCameraAndIgnoresTheRest) {
  const CameraModel camera = read_truth(
      R"({"about":"x","camera":{"cx":320.1,"cy":247.6,"depth_factor":5000,"fx":535.4,"fy":539.2,)"
      R"("height":480,"width":640,"lens":{"f":1}},"frames":[]})");
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.fx, 535.4);
  EXPECT_EQ(camera.cy, 247.6);
}

TEST(ReadTruthCamera, RefusesBadFiles) {
  EXPECT_THAT(error_of([] { (void)read_truth("{"); }), HasSubstr("not JSON"));
  EXPECT_THAT(error_of([] { (void)read_truth("[]"); }), HasSubstr("'camera'"));
  EXPECT_THAT(error_of([] { (void)read_truth(R"({"camera":{"fx":1}})"); }), HasSubstr("missing"));
}

}  // namespace
}  // namespace stillmap
