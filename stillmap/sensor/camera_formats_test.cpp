// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

CameraModel read(const std::string& text, const std::string& name = "cam.yml") {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / name, text);
  return read_camera_yaml(folder.path() / name);
}

std::string error_for(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

std::vector<double> pinhole(const CameraModel& c) {
  return {
      static_cast<double>(c.width_px), static_cast<double>(c.height_px), c.fx, c.fy, c.cx, c.cy};
}

std::vector<double> distortion(const CameraModel& c) {
  return {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6};
}

// The lines of ORB-SLAM2's TUM1.yaml that describe the camera, and some that do not.
const std::string kOrbSlam2 =
    "%YAML:1.0\n\n#----\n# Camera Parameters. Adjust them!\n#----\n\n"
    "Camera.fx: 517.306408\nCamera.fy: 516.469215\nCamera.cx: 318.643040\nCamera.cy: 255.313989\n"
    "\nCamera.k1: 0.262383\nCamera.k2: -0.953104\nCamera.p1: -0.005358\nCamera.p2: 0.002628\n"
    "Camera.k3: 1.163314\n\nCamera.width: 640\nCamera.height: 480\n\nCamera.fps: 30.0\n"
    "Camera.bf: 40.0\nCamera.RGB: 1\nThDepth: 40.0\n\nDepthMapFactor: 5000.0\n\n"
    "ORBextractor.nFeatures: 1000\nViewer.ViewpointF: 500\n";

TEST(ForeignCamera, OfOrbSlam2IsThatOfTum) {
  const CameraModel camera = read(kOrbSlam2);
  EXPECT_TRUE(same_lens(camera, builtin_camera("tum_fr1")));
  EXPECT_EQ(camera.name, "cam");
  EXPECT_EQ(camera.depth_factor, 5000.0);
  EXPECT_TRUE(camera.depth_factor_given);
}

TEST(ForeignCamera, OfOrbSlamNeedsTheSize) {
  std::string text = kOrbSlam2;
  text.replace(text.find("Camera.width: 640\n"), 18, "");
  EXPECT_THAT(error_for(text),
              AllOf(HasSubstr("cam.yml: missing Camera.width"), HasSubstr("needs lines with it")));
}

TEST(ForeignCamera, OfOrbSlam3) {
  const CameraModel pin = read(
      "%YAML:1.0\n---\nFile.version: \"1.0\"\nCamera.type: \"PinHole\"\nCamera1.fx: 382.613\n"
      "Camera1.fy: 382.614\nCamera1.cx: 320.183\nCamera1.cy: 236.455\nCamera1.k1: 0.25\n"
      "Camera1.k2: 0.\nCamera1.p1: 1.5e-03\nCamera1.p2: -2.5e-03\nCamera.width: 640\n"
      "Camera.height: 480\nCamera.newWidth: 320\nRGBD.DepthMapFactor: 1000.0\n"
      "Stereo.T_c1_c2: !!opencv-matrix\n  rows: 2\n  cols: 2\n  dt: f\n  data: [1., 0, 0, 1.]\n");
  EXPECT_THAT(pinhole(pin), ElementsAre(640, 480, 382.613, 382.614, 320.183, 236.455));
  EXPECT_THAT(distortion(pin), ElementsAre(0.25, 0, 1.5e-3, -2.5e-3, 0, 0, 0, 0));
  EXPECT_EQ(pin.depth_factor, 1000);
  EXPECT_EQ(pin.lens, LensModel::kBrownConrady);

  const std::string fisheye =
      "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera.fx: 190.97\nCamera.fy: 190.98\n"
      "Camera.cx: 254.9\nCamera.cy: 256.8\nCamera.k1: 0.0034\nCamera.k2: 0.0007\n"
      "Camera.k3: -0.002\nCamera.k4: 0.0002\nCamera2.fx: 191\nCamera.width: 512\n"
      "Camera.height: 512\n";
  const CameraModel fish = read(fisheye);
  EXPECT_EQ(fish.lens, LensModel::kFisheye);
  EXPECT_THAT(distortion(fish), ElementsAre(0.0034, 0.0007, 0, 0, -0.002, 0.0002, 0, 0));
  EXPECT_FALSE(fish.depth_factor_given);
  EXPECT_THAT(error_for("Camera.type: \"Omni\"\n" + fisheye.substr(fisheye.find("Camera.fx"))),
              AllOf(HasSubstr("cam.yml:1"), HasSubstr("'Omni'"), HasSubstr("KannalaBrandt8")));
}

TEST(ForeignCamera, OfStellaVslam) {
  const std::string rest =
      "  fx: 535.4\n  fy: 539.2\n  cx: 320.1\n  cy: 247.6\n\n  k1: 0.0\n  k2: 0.0\n  p1: 0.0\n"
      "  p2: 0.0\n  k3: 0.0\n\n  fps: 30.0\n  cols: 640\n  rows: 480\n  color_order: \"RGB\"\n\n"
      "Preprocessing:\n  min_size: 800\n  depthmap_factor: 5000.0\n"
      "  mask_rectangles:\n    - [0.0, 1.0, 0.0, 0.1]\n    - [0.0, 1.0, 0.9, 1.0]\n";
  const std::string head = "Camera:\n  name: \"TUM RGB-D 3\"\n  setup: \"RGBD\"\n  model: ";
  const CameraModel camera = read(head + "\"perspective\"\n" + rest);
  EXPECT_TRUE(same_lens(camera, builtin_camera("tum_fr3")));
  EXPECT_EQ(camera.name, "TUM RGB-D 3");
  EXPECT_EQ(camera.depth_factor, 5000.0);
  EXPECT_THAT(error_for(head + "\"equirectangular\"\n" + rest),
              HasSubstr("cam.yml:4: Camera.model is 'equirectangular', expected one of "
                        "perspective, fisheye"));
  EXPECT_THAT(error_for(head + "\"perspective\"\n  cols: 640\n"),
              HasSubstr("missing Camera.fx, Camera.fy, Camera.cx, Camera.cy, Camera.rows"));
}

TEST(ForeignCamera, OfRosCalibration) {
  const std::string text =
      "image_width: 640\nimage_height: 480\ncamera_name: head_camera\ncamera_matrix:\n  rows: 3\n"
      "  cols: 3\n  data: [438.783367, 0.000000, 305.593336, 0.0, 437.302876, 243.738352, 0, 0, "
      "1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
      "  data: [-0.361976, 0.110510, 0.001014, 0.000505, 0.000000]\nrectification_matrix:\n"
      "  rows: 3\n  cols: 3\n  data: [0.99, 0, 0, 0, 1, 0, 0, 0, 1]\n";
  const CameraModel camera = read(text);
  EXPECT_THAT(pinhole(camera),
              ElementsAre(640, 480, 438.783367, 437.302876, 305.593336, 243.738352));
  EXPECT_THAT(distortion(camera), ElementsAre(-0.361976, 0.110510, 0.001014, 0.000505, 0, 0, 0, 0));
  EXPECT_EQ(camera.name, "head_camera");
  EXPECT_FALSE(camera.depth_factor_given);
  std::string skewed = text;
  skewed.replace(skewed.find("0.000000, 305"), 8, "0.1     ");
  EXPECT_THAT(error_for(skewed), HasSubstr("cam.yml:7"));
}

TEST(ForeignCamera, OfRosMessages) {
  const std::string head = "header:\n  seq: 0\n  frame_id: \"c\"\nheight: 720\nwidth: 1280\n";
  const std::string matrix = "[609.5, 0.0, 637.7, 0.0, 609.6, 369.8, 0.0, 0.0, 1.0]\n";
  const CameraModel rational = read(
      head + "distortion_model: \"rational_polynomial\"\nD: [0.5, -2.6, 0.001, -0.0001, 1.5, " +
      "0.4, -2.4, 1.4]\nK: " + matrix + "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n");
  EXPECT_THAT(pinhole(rational), ElementsAre(1280, 720, 609.5, 609.6, 637.7, 369.8));
  EXPECT_THAT(distortion(rational), ElementsAre(0.5, -2.6, 0.001, -0.0001, 1.5, 0.4, -2.4, 1.4));
  const CameraModel fish = read(head + "distortion_model: equidistant\nd:\n- 0.1\n- 0.2\n- 0.3\n" +
                                "- 0.4\nk: " + matrix);
  EXPECT_EQ(fish.lens, LensModel::kFisheye);
  EXPECT_THAT(distortion(fish), ElementsAre(0.1, 0.2, 0, 0, 0.3, 0.4, 0, 0));
  EXPECT_THAT(error_for(head + "distortion_model: omni\nd: [0]\nk: " + matrix), HasSubstr("omni"));
}

TEST(ForeignCamera, OfOpenCvCalibration) {
  const CameraModel camera = read(
      "%YAML:1.0\n---\ncalibration_time: \"Mon\"\nimage_width: 640\nimage_height: 480\n"
      "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      "   data: [ 5.3591573396163199e+02, 0., 3.4228315473308373e+02, 0.,\n"
      "       5.3591573396163199e+02, 2.3557082909788173e+02, 0., 0., 1. ]\n"
      "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
      "   data: [ -2.6637260909660682e-01, -3.8588898922304653e-02, 1.7831947042852964e-03,\n"
      "       -2.8122100441115472e-04, 2.3839153080878486e-01 ]\navg_reprojection_error: 0.39\n");
  EXPECT_EQ(camera.fx, 535.91573396163199);
  EXPECT_EQ(camera.cx, 342.28315473308373);
  EXPECT_EQ(camera.cy, 235.57082909788173);
  EXPECT_EQ(camera.k3, 0.23839153080878486);
}

TEST(ForeignCamera, OfOpen3d) {
  const CameraModel camera = read(
      "{\n\t\"class_name\" : \"PinholeCameraIntrinsic\",\n\t\"height\" : 480,\n"
      "\t\"intrinsic_matrix\" :\n\t[\n\t\t525.0,\n\t\t0.0,\n\t\t0.0,\n\t\t0.0,\n\t\t526.0,\n"
      "\t\t0.0,\n\t\t319.5,\n\t\t239.5,\n\t\t1.0\n\t],\n\t\"width\" : 640\n}",
      "intrinsic.json");
  EXPECT_THAT(pinhole(camera), ElementsAre(640, 480, 525, 526, 319.5, 239.5));
  EXPECT_EQ(camera.name, "intrinsic");
  EXPECT_FALSE(camera.depth_factor_given);
  const CameraModel nested =
      read(R"({"intrinsic":{"width":320,"height":240,"intrinsic_matrix":[1,0,0,0,2,0,3,4,1]},)"
           R"("depth_scale":1000.0})");
  EXPECT_THAT(pinhole(nested), ElementsAre(320, 240, 1, 2, 3, 4));
  EXPECT_EQ(nested.depth_factor, 1000);
  // By rows it would be another camera.
  EXPECT_THAT(error_for(R"({"width":320,"height":240,"intrinsic_matrix":[1,0,3,0,2,4,0,0,1]})"),
              HasSubstr("columns of [fx 0 cx; 0 fy cy; 0 0 1]"));
}

TEST(ForeignCamera, OfRealSense) {
  const auto with = [](const std::string& model) {
    return R"({"width": 1280, "height": 720, "ppx": 640.1, "ppy": 360.2, "fx": 920.5,)"
           R"( "fy": 921.5, "model": ")" +
           model + R"(", "coeffs": [0.1, -0.2, 0.001, 0.002, 0.3]})";
  };
  const CameraModel camera = read(with("distortion.brown_conrady"));
  EXPECT_THAT(pinhole(camera), ElementsAre(1280, 720, 920.5, 921.5, 640.1, 360.2));
  EXPECT_THAT(distortion(camera), ElementsAre(0.1, -0.2, 0.001, 0.002, 0.3, 0, 0, 0));
  EXPECT_EQ(read(with("Brown Conrady")).k3, 0.3);
  EXPECT_THAT(error_for(with("distortion.inverse_brown_conrady")),
              AllOf(HasSubstr("cam.yml:1"), HasSubstr("expected brown_conrady")));
  const CameraModel none =
      read(R"({"width":848,"height":480,"fx":1,"fy":1,"ppx":1,"ppy":1,"coeffs":[0,0,0,0,0],)"
           R"("model":"distortion.inverse_brown_conrady"})");
  EXPECT_FALSE(none.distorted());
}

TEST(ForeignCamera, RefusesMoreThanACameraHas) {
  const std::string bomb =
      "a: &a [1,1,1,1,1,1,1,1,1,1]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]\n"
      "c: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]\nd: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]\n"
      "e: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: &f [*e,*e,*e,*e,*e,*e,*e,*e,*e,*e]\n"
      "g: &g [*f,*f,*f,*f,*f,*f,*f,*f,*f,*f]\nh: &h [*g,*g,*g,*g,*g,*g,*g,*g,*g,*g]\n";
  EXPECT_THAT(error_for(bomb), HasSubstr("more than 10000 values"));
}

}  // namespace
}  // namespace stillmap
