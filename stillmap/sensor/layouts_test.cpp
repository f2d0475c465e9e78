// SPDX-License-Identifier: Apache-2.0
// The same frames in every layout: whatever the files are called, what comes out has the same bits
// as the folder in the layout of the TUM benchmark.
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kFrames = 4;

CameraModel small_camera(double depth_factor) {
  CameraModel camera;
  camera.name = "small";
  camera.width_px = 16;
  camera.height_px = 12;
  camera.fx = 20;
  camera.fy = 21;
  camera.cx = 7.5;
  camera.cy = 5.25;
  camera.depth_factor = depth_factor;
  return camera;
}

Eigen::Isometry3d true_pose(int frame) {
  return make_pose(so3_exp(Eigen::Vector3d(0.1, -0.2, 0.3) * frame),
                   {0.5 * frame, 1, -0.25 * frame});
}

std::string matrix_text(const Eigen::Isometry3d& T) {
  std::string text;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c)
      text += fmt::format("{:.10f}{}", T.matrix()(r, c), c < 3 ? " " : "\n");
  }
  return text;
}

std::string tum_text(const std::string& stamp, const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return fmt::format("{} {} {} {} {:.10f} {:.10f} {:.10f} {:.10f}\n",
                     stamp,
                     t.x(),
                     t.y(),
                     t.z(),
                     q.x(),
                     q.y(),
                     q.z(),
                     q.w());
}

class Layouts : public ::testing::Test {
 protected:
  Layouts() {
    std::mt19937 rng(7);
    for (int i = 0; i < kFrames; ++i) {
      colors_[i] = cv::Mat3b(12, 16);
      millimetres_[i] = cv::Mat1w(12, 16);
      for (cv::Vec3b& pixel : colors_[i]) {
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(rng() % 256);
      }
      for (std::uint16_t& depth : millimetres_[i]) depth = static_cast<std::uint16_t>(rng() % 8000);
    }
    std::string rgb, depth, poses;
    for (int i = 0; i < kFrames; ++i) {
      const std::string stamp = fmt::format("{}", i / 30.0);
      write(fmt::format("tum/rgb/{}.png", i), color_png(i));
      write(fmt::format("tum/depth/{}.png", i), depth_png(i, 5));
      rgb += fmt::format("{} rgb/{}.png\n", stamp, i);
      depth += fmt::format("{} depth/{}.png\n", stamp, i);
      poses += tum_text(stamp, true_pose(i));
    }
    write("tum/rgb.txt", rgb);
    write("tum/depth.txt", depth);
    write("tum/groundtruth.txt", poses);
    write("tum/camera.yaml", format_camera_yaml(small_camera(5000)));
  }

  [[nodiscard]] std::string color_png(int frame) const {
    return encode_png(ColorImage(colors_[frame]));
  }
  // Depth in units of 1/scale millimetres.
  [[nodiscard]] std::string depth_png(int frame, int scale) const {
    cv::Mat1f metres;
    millimetres_[frame].convertTo(metres, CV_32F, 0.001);
    return encode_depth_png(DepthImage(metres), 1000.0 * scale);
  }

  void write(const std::string& name, std::string_view bytes) const {
    fs::create_directories((base_.path() / name).parent_path());
    write_file_atomically(base_.path() / name, bytes);
  }

  // Writes the pairs, the first of which is called `first`, under names with numbers in {}.
  void write_frames(const std::string& color,
                    const std::string& depth,
                    int scale,
                    int first = 0,
                    int step = 1) const {
    for (int i = 0; i < kFrames; ++i) {
      write(fmt::format(fmt::runtime(color), first + step * i), color_png(i));
      write(fmt::format(fmt::runtime(depth), first + step * i), depth_png(i, scale));
    }
  }

  // Expects the frames of the TUM folder, `first_s` later, and its true poses.
  void expect_same(const Sequence& sequence,
                   std::string_view format,
                   double first_s = 0,
                   bool with_truth = true) const {
    EXPECT_EQ(sequence.format(), format);
    const Sequence reference = Sequence::open(base_.path() / "tum");
    ASSERT_EQ(sequence.size(), reference.size());
    const std::optional<GroundTruth> truth = sequence.groundtruth();
    ASSERT_EQ(truth.has_value(), with_truth);
    const std::size_t poses = truth ? truth->poses.size() : 0;
    ASSERT_EQ(poses, with_truth ? reference.size() : 0U);
    const Trajectory true_poses = reference.groundtruth().value().poses;
    for (std::uint32_t i = 0; i < sequence.size(); ++i) {
      const FramePtr a = reference.read(FrameId(i)), b = sequence.read(FrameId(i));
      EXPECT_NEAR(b->stamp.seconds - first_s, a->stamp.seconds, 1e-9);
      EXPECT_EQ(b->depth_stamp_s, b->stamp.seconds);
      EXPECT_EQ(cv::norm(a->color.mat, b->color.mat, cv::NORM_INF), 0.0);
      EXPECT_EQ(cv::norm(a->gray.mat, b->gray.mat, cv::NORM_INF), 0.0);
      EXPECT_EQ(cv::norm(a->depth.mat, b->depth.mat, cv::NORM_INF), 0.0);
      if (!truth) continue;
      EXPECT_EQ(truth->poses[i].stamp.seconds, b->stamp.seconds);
      const Eigen::Isometry3d off =
          true_poses[i].T_world_camera.inverse() * truth->poses[i].T_world_camera;
      EXPECT_LT((off.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 1e-8);
    }
  }

  [[nodiscard]] fs::path folder(const char* name) const { return base_.path() / name; }

  TemporaryFolder base_;
  cv::Mat3b colors_[kFrames];
  cv::Mat1w millimetres_[kFrames];
};

TEST_F(Layouts, SevenScenes) {
  write_frames("seq-01/frame-{:06}.color.png", "seq-01/frame-{:06}.depth.png", 1);
  for (int i = 0; i < kFrames; ++i) {
    write(fmt::format("seq-01/frame-{:06}.pose.txt", i), matrix_text(true_pose(i)));
  }
  const Sequence own = Sequence::open(folder("seq-01"), {.camera = small_camera(1000)});
  expect_same(own, "7scenes");
  EXPECT_EQ(own.entry(FrameId(1)).stamp.text, "0.033333");
  EXPECT_EQ(Sequence::open(folder("seq-01")).camera().fx, 585);
  write("seq-01/frame-000002.pose.txt",
        "nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan");
  fs::remove(folder("seq-01") / "frame-000001.pose.txt");
  GroundTruth truth = own.groundtruth().value();
  EXPECT_EQ(truth.poses.size(), 2U);
  EXPECT_THAT(truth.warnings, ElementsAre(HasSubstr("seq-01: 2 frames without a finite pose")));
  write("seq-01/frame-000002.pose.txt", "2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  truth = own.groundtruth().value();
  EXPECT_TRUE(truth.poses.empty());
  EXPECT_THAT(truth.warnings, ElementsAre(HasSubstr("frame-000002.pose.txt: no rotation matrix")));
}

// Published poses of ICL-NUIM are of a camera with y up. Here they are made from the true ones by
// reflecting points, not by the reader's formula.
TEST_F(Layouts, IclNuim) {
  write_frames("traj/rgb/{}.png", "traj/depth/{}.png", 5, 1);
  std::string pairs, poses;
  const Eigen::DiagonalMatrix<double, 3> up(1, -1, 1);
  for (int i = 0; i < kFrames; ++i) {
    pairs += fmt::format("{0} depth/{0}.png {0} rgb/{0}.png\n", i + 1);
    Eigen::Isometry3d published;
    const Eigen::Vector3d centre = up * (true_pose(i) * Eigen::Vector3d::Zero());
    published.translation() = centre;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d of_camera = up * Eigen::Vector3d::Unit(axis);  // to y down
      published.linear().col(axis) = up * (true_pose(i) * of_camera) - centre;
    }
    poses += tum_text(fmt::format("{}", i + 1), published);
  }
  write("traj/associations.txt", pairs);
  write("traj/livingRoom0.gt.freiburg", poses);
  const Sequence own = Sequence::open(folder("traj"), {.camera = small_camera(5000)});
  expect_same(own, "icl", 1 / 30.0);
  EXPECT_EQ(own.entry(FrameId(0)).stamp.text, "1");
  EXPECT_EQ(Sequence::open(folder("traj")).camera().fy, 480);
  write("original/scene_00_0000.depth", "1 2 3");
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder("original")); }),
              HasSubstr("depth along the ray"));
}

TEST_F(Layouts, ScanNet) {
  write_frames("scene/color/{}.png", "scene/depth/{}.png", 1, 0, 20);
  for (int i = 0; i < kFrames; ++i)
    write(fmt::format("scene/pose/{}.txt", 20 * i), matrix_text(true_pose(i)));
  write("scene/intrinsic/intrinsic_depth.txt", "20 0 7.5 0\n0 21 5.25 0\n0 0 1 0\n0 0 0 1\n");
  Sequence own = Sequence::open(folder("scene"));
  EXPECT_EQ(own.camera().fx, 20);
  EXPECT_EQ(own.camera().cy, 5.25);
  EXPECT_THAT(own.remarks().notes,
              ElementsAre("names of images: stamps are frame numbers, at 30 Hz"));
  SequenceOptions options;
  options.reading.rate_hz = 600;
  expect_same(Sequence::open(folder("scene"), options), "scannet");

  // Colour twice as large: a pixel of depth lies in the middle of four of colour.
  cv::Mat3b large(24, 32);
  for (int v = 0; v < 24; ++v) {
    for (int u = 0; u < 32; ++u)
      large(v, u) =
          cv::Vec3b(static_cast<std::uint8_t>(8 * u), static_cast<std::uint8_t>(10 * v), 7);
  }
  for (int i = 0; i < kFrames; ++i)
    write(fmt::format("scene/color/{}.png", 20 * i), encode_png(ColorImage(large)));
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder("scene")); }),
              HasSubstr("intrinsic_color.txt"));
  write("scene/intrinsic/intrinsic_color.txt", "40 0 15.5 0\n0 42 11 0\n0 0 1 0\n0 0 0 1\n");
  own = Sequence::open(folder("scene"));
  const cv::Mat3b resampled = own.read(FrameId(0))->color.mat;
  for (int v = 0; v < 12; ++v) {
    for (int u = 0; u < 16; ++u) {  // u_color = 2 u + 0.5, v_color = 2 v + 0.5
      EXPECT_NEAR(resampled(v, u)[0], 8 * (2 * u + 0.5), 1) << u << ' ' << v;
      EXPECT_NEAR(resampled(v, u)[1], 10 * (2 * v + 0.5), 1) << u << ' ' << v;
    }
  }
}

TEST_F(Layouts, Open3dAndRedwood) {
  write_frames("o3d/color/{:06}.png", "o3d/depth/{:06}.png", 1);
  write("o3d/camera_intrinsic.json",
        R"({"width":16,"height":12,"intrinsic_matrix":[20,0,0,0,21,0,7.5,5.25,1],"fps":30})");
  std::string log;
  for (int i = 0; i < kFrames; ++i)
    log += fmt::format("{0} {0} {1}\n", i, i + 1) + matrix_text(true_pose(i));
  write("o3d/trajectory.log", log);
  expect_same(Sequence::open(folder("o3d")), "images");
  EXPECT_EQ(Sequence::open(folder("o3d")).camera().fy, 21);
  fs::rename(folder("o3d") / "depth" / "000001.png", folder("o3d") / "depth" / "000009.png");
  EXPECT_THAT(Sequence::open(folder("o3d")).groundtruth().value().warnings,
              ElementsAre(HasSubstr("trajectory.log counts colour images")));
  write("o3d/camera_intrinsic.json", R"({"width":16,"height":12,"intrinsic_matrix":[20,0,0]})");
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder("o3d")); }),
              HasSubstr("camera_intrinsic.json: 'intrinsic_matrix' is no list of 9 numbers"));
}

TEST_F(Layouts, DumpsByFrameNumberOrByStamp) {
  write_frames("dump/rgb/color_{:04}.png", "dump/depth/depth_{:04}.png", 1);
  fs::remove(folder("dump") / "depth" / "depth_0003.png");
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder("dump")); }), HasSubstr("camera.yaml"));
  write("dump/camera.yaml", format_camera_yaml(small_camera(1000)));
  const Sequence dump = Sequence::open(folder("dump"));
  EXPECT_EQ(dump.size(), 3U);
  EXPECT_THAT(dump.remarks().notes,
              testing::Contains(HasSubstr("1 of 4 colour images have no depth image")));
  write("dump/rgb/other_0001.png", color_png(0));
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder("dump")); }),
              HasSubstr("the same number"));

  // Redwood's names end with microseconds, those of other tools are stamps in seconds.
  for (int i = 0; i < kFrames; ++i) {
    const double s = i / 30.0;
    write(fmt::format("us/image/{:07}-{:012.0f}.png", i + 1, 1e6 * s), color_png(i));
    write(fmt::format("us/depth/{:07}-{:012.0f}.png", i + 1, 1e6 * s + 4000), depth_png(i, 1));
    write(fmt::format("s/rgb/{:.6f}.png", 1305031102 + s), color_png(i));
    write(fmt::format("s/depth/{:.6f}.png", 1305031102.004 + s), depth_png(i, 1));
  }
  for (const auto& [name, first_s] : {std::pair("us", 0.0), std::pair("s", 1305031102.0)}) {
    write(fmt::format("{}/camera.yaml", name), format_camera_yaml(small_camera(1000)));
    const Sequence own = Sequence::open(folder(name));
    ASSERT_EQ(own.size(), 4U);
    for (std::uint32_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(own.entry(FrameId(i)).stamp.seconds, first_s + i / 30.0, 2e-6);
      EXPECT_NEAR(own.entry(FrameId(i)).depth_stamp_s, first_s + i / 30.0 + 0.004, 2e-6);
      EXPECT_EQ(cv::norm(own.read(FrameId(i))->color.mat, colors_[i], cv::NORM_INF), 0.0);
    }
    EXPECT_THAT(own.remarks().notes,
                testing::Contains("depth images are 4.0 ms after colour images (median)"));
  }
}

TEST_F(Layouts, PairsHaveTheTextsOfTheListIfItHasThemAll) {
  write_frames("pairs/rgb/{}.png", "pairs/depth/{}.png", 5);
  write("pairs/associations.txt",
        "500000000 rgb/0.png 500000000 depth/0.png\n1000000000 rgb/1.png 1000000000 depth/1.png\n");
  const auto texts = [&](const char* list) {
    write("pairs/rgb.txt", list);
    const Sequence pairs = Sequence::open(folder("pairs"), {.camera = small_camera(5000)});
    return std::vector{pairs.entry(FrameId(0)).stamp.text, pairs.entry(FrameId(1)).stamp.text};
  };
  EXPECT_THAT(texts("0.5 rgb/0.png\n1 rgb/1.png\n"), ElementsAre("0.5", "1"));
  EXPECT_THAT(texts("1 rgb/1.png\n"), ElementsAre("500000000", "1000000000")) << "of one unit";
}

TEST_F(Layouts, Bonn) {
  fs::rename(folder("tum"), folder("rgbd_bonn_crowd"));
  fs::remove(folder("rgbd_bonn_crowd") / "camera.yaml");
  const Sequence bonn = Sequence::open(folder("rgbd_bonn_crowd"));
  EXPECT_EQ(bonn.format(), "tum");
  EXPECT_EQ(bonn.camera().name, "bonn");
}

}  // namespace
}  // namespace stillmap
