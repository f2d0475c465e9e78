// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kGood = "width: 320\nheight: 240\nfx: 250.5\nfy: 251\ncx: 160\ncy: 1.2e2\n";

CameraModel read(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "camera.yaml", text);
  return read_camera_yaml(folder.path() / "camera.yaml");
}

std::string error_for(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

CameraModel read_truth(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "objects.json", text);
  return read_truth_camera(folder.path() / "objects.json");
}

TEST(ReadCameraYaml, ReadsTheKeysAndDefaultsTheRest) {
  const CameraModel camera = read(std::string(kGood) + "k2: -0.25\n");
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
    const CameraModel read_back = read(format_camera_yaml(camera));
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

TEST(ReadCameraYaml, RefusesAnUnknownKeyWithItsLineAndTheNearest) {
  EXPECT_THAT(error_for(std::string(kGood) + "depth_facto: 1000\n"),
              AllOf(HasSubstr("camera.yaml:7"), HasSubstr("did you mean 'depth_factor'?")));
}

TEST(ReadCameraYaml, RefusesValuesThatCannotBe) {
  const std::string good = kGood;
  EXPECT_THAT(error_for(good + "k1: .nan\n"), HasSubstr("camera.yaml:7: k1 is '.nan'"));
  EXPECT_THAT(error_for(good + "k1: inf\n"), HasSubstr("finite"));
  EXPECT_THAT(error_for(good + "k1: 1,5\n"), HasSubstr("finite number"));
  EXPECT_THAT(error_for(good + "k1: [1]\n"), HasSubstr("one value for each key"));
  EXPECT_THAT(error_for(good + "k1:\n"), HasSubstr("camera.yaml:7: expected one value"));
  EXPECT_THAT(error_for(good + "depth_factor: 0\n"), HasSubstr("positive"));
  EXPECT_THAT(error_for(good + "fx: 3\n"), HasSubstr("fx is given twice"));
  EXPECT_THAT(error_for("width: 0\nheight: 2\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"), HasSubstr("width"));
  EXPECT_THAT(error_for("width: 2\nheight: 9000\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"),
              HasSubstr("height is 9000, expected 1 to 8192"));
  EXPECT_THAT(error_for("width: 2.5\nheight: 2\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n"),
              HasSubstr("whole number"));
  EXPECT_THAT(error_for("width: 2\nheight: 2\nfx: -1\nfy: 1\ncx: 1\ncy: 1\n"),
              HasSubstr("fx is -1, expected a positive number"));
}

TEST(ReadCameraYaml, RefusesWhatIsNoCamera) {
  EXPECT_THAT(error_for("width: 320\nfx: 1\n"), HasSubstr("missing height, fy, cx, cy"));
  EXPECT_THAT(error_for(""), HasSubstr("not a camera"));
  EXPECT_THAT(error_for("- 1\n- 2\n"), HasSubstr("not a camera"));
  EXPECT_THAT(error_for("fx: 1\nfy: [1, 2\n"), AllOf(HasSubstr("camera.yaml:"), HasSubstr("YAML")));
  EXPECT_THAT(error_for(std::string(100000, '[')), HasSubstr("camera.yaml"));
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
