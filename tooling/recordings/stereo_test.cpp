// SPDX-License-Identifier: Apache-2.0
// Stereo recordings of a picture on a slanted wall, which the test renders ray by ray.
#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/support/files.hpp"
#include "tooling/recordings/recording_formats.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kWidth = 320, kHeight = 200;

// The wall z = kWall_m + kSlope * x in the world.
constexpr double kWall_m = 2.0, kSlope = 0.3;

double depth_on_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
  return (kWall_m + kSlope * from.x() - from.z()) / (way.z() - kSlope * way.x());
}

// The image of the wall through a camera, lens included.
ColorImage picture_of_wall(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera) {
  cv::Mat3b picture(600, 1200);
  cv::RNG rng(3);
  rng.fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(picture, picture, {5, 5}, 1.2);
  constexpr double kPixelsPerM = 240;
  cv::Mat2f position(camera.height_px, camera.width_px);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector3d way =
          T_world_camera.linear() * camera.unproject(camera.undistort(Eigen::Vector2d(u, v)), 1.0);
      const Eigen::Vector3d from = T_world_camera.translation();
      const Eigen::Vector3d p = from + depth_on_ray(from, way) * way;
      position(v, u) = cv::Vec2f(static_cast<float>(600 + kPixelsPerM * p.x()),
                                 static_cast<float>(300 + kPixelsPerM * p.y()));
    }
  }
  cv::Mat3b image;
  cv::remap(picture, image, position, cv::noArray(), cv::INTER_LINEAR);
  return ColorImage(image);
}

CameraModel pinhole(double focal_px) {
  CameraModel camera;
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  camera.fx = camera.fy = focal_px;
  camera.cx = 0.5 * kWidth - 3;
  camera.cy = 0.5 * kHeight + 2;
  return camera;
}

Eigen::Isometry3d turned(double x_deg, double y_deg, double z_deg, const Eigen::Vector3d& t) {
  const Eigen::Vector3d w = Eigen::Vector3d(x_deg, y_deg, z_deg) * (M_PI / 180);
  return make_pose(so3_exp(w), t);
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

void write_image(const fs::path& file, const ColorImage& image) {
  write(file, encode_png(image));
}

// Expects the depth of most pixels, and nearly all of these within half a pixel of the wall's
// disparity.
void expect_wall(const DepthImage& depth,
                 const Sequence& sequence,
                 const Eigen::Isometry3d& T_world_camera) {
  const CameraModel& camera = sequence.camera();
  const double product = 3 * sequence.depth_noise().value().max_depth_m;  // disparity * depth
  int known = 0, good = 0;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const double seen = static_cast<double>(depth.mat(v, u));
      if (seen == 0) continue;
      ++known;
      const Eigen::Vector3d way =
          T_world_camera.linear() * camera.unproject(Eigen::Vector2d(u, v), 1.0);
      const double expected = depth_on_ray(T_world_camera.translation(), way);
      good += std::abs(product / seen - product / expected) < 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(known, 0.85 * kWidth * kHeight);
  EXPECT_GT(good, 0.98 * known);
}

std::string sensor_yaml(const CameraModel& c, const Eigen::Isometry3d& T_body_camera) {
  std::string data;
  for (int i = 0; i < 16; ++i) {
    data += fmt::format("{}{}", i > 0 ? ", " : "", T_body_camera.matrix()(i / 4, i % 4));
  }
  return fmt::format(
      "#Default sensor yaml file\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [{}]\n"
      "rate_hz: 20\nresolution: [{}, {}]\ncamera_model: pinhole\nintrinsics: [{}, {}, {}, {}]\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [{}, {}, {}, {}]\n",
      data,
      c.width_px,
      c.height_px,
      c.fx,
      c.fy,
      c.cx,
      c.cy,
      c.k1,
      c.k2,
      c.p1,
      c.p2);
}

SequenceOptions all_formats() {
  SequenceOptions options;
  options.formats = recording_formats();
  return options;
}

/// Two cameras with lenses, not quite parallel, on a body that looks along its x axis, as the EuRoC
/// data sets have it. Two pairs; the body moves 0.1 m to the right in between.
class EurocFolder : public testing::Test {
 protected:
  EurocFolder() {
    left_ = right_ = pinhole(240);
    left_.k1 = -0.28;
    left_.k2 = 0.07;
    left_.p1 = 2e-4;
    right_.k1 = -0.27;
    right_.k2 = 0.06;
    right_.fx = right_.fy = 238;
    Eigen::Matrix3d axes;  // of the camera, in the body's: right = -y, down = -z, forward = x
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T_body_left_.linear() = axes;
    T_body_left_.translation() = Eigen::Vector3d(0.05, 0.06, 0.02);
    T_body_right_ = T_body_left_ * turned(0.8, -1.1, 0.6, {0.12, 0.002, -0.001});
    for (int i = 0; i < 2; ++i) {
      T_world_left_[i] = turned(1, 2, 3, {0.1 * i, 0, 0});
      const Eigen::Isometry3d T_world_body = T_world_left_[i] * T_body_left_.inverse();
      const std::string stamp = fmt::format("14036365797{}3555584", i);
      list_ += fmt::format("{0},{0}.png\r\n", stamp);
      const Eigen::Vector3d t = T_world_body.translation();
      const Eigen::Quaterniond q(T_world_body.rotation());
      poses_ += fmt::format("{},{},{},{},{},{},{},{},0,0,0\n",
                            stamp,
                            t.x(),
                            t.y(),
                            t.z(),
                            q.w(),
                            q.x(),
                            q.y(),
                            q.z());
      write_image(mav_ / "cam0" / "data" / (stamp + ".png"),
                  picture_of_wall(left_, T_world_left_[i]));
      write_image(mav_ / "cam1" / "data" / (stamp + ".png"),
                  picture_of_wall(right_, T_world_body * T_body_right_));
    }
    write(mav_ / "cam0" / "data.csv", list_);
    write(mav_ / "cam1" / "data.csv", list_);
    write(mav_ / "cam0" / "sensor.yaml", sensor_yaml(left_, T_body_left_));
    write(mav_ / "cam1" / "sensor.yaml", sensor_yaml(right_, T_body_right_));
    write(mav_ / "state_groundtruth_estimate0" / "data.csv", "#timestamp,p,q,v\n" + poses_);
  }

  TemporaryFolder folder_;
  fs::path mav_ = folder_.path() / "mav0";
  CameraModel left_, right_;
  Eigen::Isometry3d T_body_left_ = Eigen::Isometry3d::Identity(), T_body_right_;
  Eigen::Isometry3d T_world_left_[2];
  std::string list_ = "#timestamp [ns],filename\r\n", poses_;
};

TEST_F(EurocFolder, IsRectifiedAndGivesDepth) {
  for (const fs::path& path : {folder_.path(), mav_}) {
    const Sequence sequence = Sequence::open(path, all_formats());
    EXPECT_EQ(sequence.format(), "euroc");
    ASSERT_EQ(sequence.size(), 2U);
    EXPECT_EQ(sequence.entry(FrameId(1)).stamp.text, "1403636579.713555584");
    EXPECT_FALSE(sequence.camera().distorted());
    EXPECT_EQ(sequence.camera().fx, sequence.camera().fy);
    const GroundTruth truth = sequence.groundtruth().value();
    ASSERT_EQ(truth.poses.size(), 2U);
    EXPECT_TRUE(truth.warnings.empty());
    for (std::uint32_t i = 0; i < 2; ++i) {
      const Eigen::Isometry3d& T_world_camera = truth.poses[i].T_world_camera;
      // The centre of the left camera stays where it is; rectifying turns it a little.
      EXPECT_LT((T_world_camera.translation() - T_world_left_[i].translation()).norm(), 1e-9);
      EXPECT_GT(rotation_angle((T_world_left_[i].inverse() * T_world_camera).rotation()), 0.001);
      EXPECT_LT(rotation_angle((T_world_left_[i].inverse() * T_world_camera).rotation()), 0.05);
      const FramePtr frame = sequence.read(FrameId(i));
      expect_wall(frame->depth, sequence, T_world_camera);
      // The rectified image is what a camera there would see.
      const ColorImage expected = picture_of_wall(sequence.camera(), T_world_camera);
      EXPECT_LT(cv::norm(frame->color.mat, expected.mat, cv::NORM_L1) / (3 * kWidth * kHeight), 6);
    }
  }
}

TEST_F(EurocFolder, HasTheNoiseOfItsDisparities) {
  const Sequence sequence = Sequence::open(folder_.path(), all_formats());
  const double baseline_m = (T_body_left_.inverse() * T_body_right_).translation().norm();
  const double product = sequence.camera().fx * baseline_m;
  ASSERT_TRUE(sequence.depth_noise());
  EXPECT_NEAR(sequence.depth_noise()->inverse_depth_sigma, 1 / product, 1e-6);
  EXPECT_NEAR(sequence.depth_noise()->max_depth_m, product / 3, 1e-6);
}

TEST_F(EurocFolder, LeavesImagesOutThatHaveNoPartner) {
  write(mav_ / "cam1" / "data.csv", list_.substr(0, list_.rfind("14036365797", list_.rfind(','))));
  const Sequence sequence = Sequence::open(folder_.path(), all_formats());
  EXPECT_EQ(sequence.size(), 1U);
  EXPECT_THAT(sequence.remarks().notes.back(), HasSubstr("1 images of cam0 have no partner"));
}

TEST_F(EurocFolder, RefusesWhatItCannotRead) {
  const auto error = [&] {
    return error_of([&] { (void)Sequence::open(folder_.path(), all_formats()); });
  };
  SequenceOptions with_camera = all_formats();
  with_camera.camera = pinhole(300);
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder_.path(), with_camera); }),
              HasSubstr("leave out --camera"));
  write(mav_ / "cam1" / "data.csv", "17,../../secret.png\n");
  EXPECT_THAT(error(), HasSubstr("data.csv:1"));
  write(mav_ / "cam1" / "data.csv", "#head\n1.7,a.png\n");
  EXPECT_THAT(error(), HasSubstr("data.csv:2: '1.7,a.png', expected a stamp in nanoseconds"));
  write(mav_ / "cam1" / "data.csv", "17,a.png\n");
  EXPECT_THAT(error(), HasSubstr("no stamp is in both"));
  write(mav_ / "cam1" / "sensor.yaml", sensor_yaml(right_, T_body_left_));
  EXPECT_THAT(error(), HasSubstr("expected a camera to the right"));
  std::string fisheye = sensor_yaml(right_, T_body_right_);
  fisheye.replace(fisheye.find("radial-tangential"), 17, "equidistant");
  write(mav_ / "cam1" / "sensor.yaml", fisheye);
  EXPECT_THAT(error(), HasSubstr("distortion_model is equidistant"));
}

TEST_F(EurocFolder, GoesWithoutTruePosesThatAreBroken) {
  write(mav_ / "state_groundtruth_estimate0" / "data.csv", "1,2,3\n");
  const GroundTruth truth = Sequence::open(folder_.path(), all_formats()).groundtruth().value();
  EXPECT_TRUE(truth.poses.empty());
  ASSERT_EQ(truth.warnings.size(), 1U);
}

/// Rectified pairs of colour cameras 2 and 3, which are beside camera 0; the first pair of gray
/// cameras is there, too.
class KittiFolder : public testing::Test {
 protected:
  KittiFolder() {
    camera_ = pinhole(260);
    std::string poses;
    for (int i = 0; i < 2; ++i) {
      T_world_left_[i] = turned(0, 2 * i, 0, {0.1 * i, 0, 0});
      const std::string name = fmt::format("{:06}.png", i);
      for (int k = 0; k < 4; ++k) {
        write_image(root_ / fmt::format("image_{}", k) / name,
                    picture_of_wall(
                        camera_, T_world_left_[i] * Eigen::Translation3d(x_m(k) - x_m(2), 0, 0)));
      }
      const Eigen::Isometry3d T_world_first =
          T_world_left_[i] * Eigen::Translation3d(-x_m(2), 0, 0);
      for (int j = 0; j < 12; ++j) {
        poses += fmt::format("{}{}", T_world_first.matrix()(j / 4, j % 4), j < 11 ? " " : "\n");
      }
    }
    std::string calibration;
    for (int k = 0; k < 4; ++k) {
      calibration += fmt::format("P{}: {} 0 {} {} 0 {} {} 0 0 0 1 0\n",
                                 k,
                                 camera_.fx,
                                 camera_.cx,
                                 -camera_.fx * x_m(k),
                                 camera_.fy,
                                 camera_.cy);
    }
    write(root_ / "calib.txt", calibration);
    write(root_ / "times.txt", "0.000000e+00\n1.037875e-01\n");
    write(folder_.path() / "poses" / "04.txt", poses);
  }

  // The position of a camera on the x axis of camera 0.
  static double x_m(int camera) {
    return std::array<double, 4>{0, 0.14, -0.02, 0.11}[static_cast<std::size_t>(camera)];
  }

  TemporaryFolder folder_;
  fs::path root_ = folder_.path() / "sequences" / "04";
  CameraModel camera_;
  Eigen::Isometry3d T_world_left_[2];
};

TEST_F(KittiFolder, GivesDepthAndTruePoses) {
  const Sequence sequence = Sequence::open(root_, all_formats());
  EXPECT_EQ(sequence.format(), "kitti");
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.entry(FrameId(1)).stamp.text, "1.037875e-01");
  EXPECT_EQ(sequence.entry(FrameId(1)).color_file.parent_path().filename(), "image_2");
  EXPECT_EQ(sequence.camera().fx, camera_.fx);
  EXPECT_NEAR(sequence.depth_noise()->inverse_depth_sigma, 1 / (camera_.fx * 0.13), 1e-9);
  const GroundTruth truth = sequence.groundtruth().value();
  ASSERT_EQ(truth.poses.size(), 2U);
  for (std::uint32_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(truth.poses[i].T_world_camera.isApprox(T_world_left_[i], 1e-6));
    expect_wall(sequence.read(FrameId(i))->depth, sequence, T_world_left_[i]);
  }
}

TEST_F(KittiFolder, UsesTheGrayCamerasWhereThereAreNoOthers) {
  fs::remove_all(root_ / "image_3");
  const Sequence sequence = Sequence::open(root_, all_formats());
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_file.parent_path().filename(), "image_1");
  EXPECT_NEAR(sequence.depth_noise()->max_depth_m, camera_.fx * 0.14 / 3, 1e-9);
}

TEST_F(KittiFolder, RefusesWhatItCannotRead) {
  const auto error = [&] { return error_of([&] { (void)Sequence::open(root_, all_formats()); }); };
  write(root_ / "calib.txt", "P2: 1 2 3\n");
  EXPECT_THAT(error(), HasSubstr("row P2: has 3 numbers, expected twelve"));
  write(root_ / "calib.txt", "P1: 1\n");
  EXPECT_THAT(error(), HasSubstr("no row P2:"));
  write(root_ / "times.txt", "1\n0.5\n");
  EXPECT_THAT(error(), HasSubstr("times.txt:2: stamp 0.5 does not come after 1"));
}

}  // namespace
}  // namespace stillmap
