// SPDX-License-Identifier: Apache-2.0
// A rendered scene through each row of the table in docs/inputs.md: the run has the trajectory of
// the folder in the layout of TUM. (The readers alone are compared bit by bit in layouts_test.cpp.)
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "simulation/synth/sequence.hpp"
#include "simulation/synth/sequence_writer.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/files.hpp"
#include "tests/support/oni_writer.hpp"
#include "tooling/pipeline/run_sequence.hpp"
#include "tooling/recordings/recording_formats.hpp"

#if STILLMAP_WITH_BAG_WRITER
#include "tests/support/bags/bag_messages.hpp"
#endif

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFrames = 20;
constexpr double kBaselineM = 0.1;
// Where stamps are those of the reference, and where a format counts frames or rounds.
constexpr double kExact = 1e-9, kRounded = 1e-6;

/// The scene as it was rendered, with stereo pairs, and its frames with depth in millimetres.
class Scene {
 public:
  Scene() {
    SyntheticOptions options;
    options.camera = synthetic_camera(320, 240);
    options.frames = kFrames;
    write_sequence(SyntheticSequence(options),
                   folder_.path(),
                   {.threads = 2, .stereo_baseline_m = kBaselineM});
    const Sequence rendered = Sequence::open(folder_.path());
    camera = rendered.camera();
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      const FramePtr frame = rendered.read(FrameId(i));
      colors.push_back(frame->color);
      cv::Mat1w units;
      frame->depth.mat.convertTo(units, CV_16U, 1000);
      millimetres.push_back(units);
    }
  }

  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

  CameraModel camera;
  std::vector<ColorImage> colors;
  std::vector<cv::Mat1w> millimetres;

 private:
  TemporaryFolder folder_;
};

const Scene& scene() {
  static const Scene kScene;
  return kScene;
}

std::string stamp(std::uint32_t frame) {
  return fmt::format("{:.6f}", 100 + frame / 30.0);
}

Trajectory trajectory_of(const fs::path& path,
                         const std::string& format,
                         const char* forced = "",
                         std::optional<CameraModel> camera = {}) {
  const Sequence sequence = Sequence::open(
      path, {.camera = std::move(camera), .format = forced, .formats = recording_formats()});
  EXPECT_EQ(sequence.format(), format);
  SequenceStream frames(sequence);
  RunOptions options;
  options.threads = 2;
  return run_sequence(frames, {}, std::move(options)).result.trajectory;
}

void expect_same(const Trajectory& actual, const Trajectory& expected, double tolerance) {
  ASSERT_EQ(expected.size(), kFrames);
  ASSERT_EQ(actual.size(), kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const Eigen::Matrix4d off =
        actual[i].T_world_camera.matrix() - expected[i].T_world_camera.matrix();
    EXPECT_LE(off.cwiseAbs().maxCoeff(), tolerance) << i;
  }
}

/// A folder for recordings of the scene.
class Recordings {
 public:
  void write(const std::string& name, std::string_view bytes) const {
    fs::create_directories((base_.path() / name).parent_path());
    write_file_atomically(base_.path() / name, bytes);
  }
  // `units`: of depth in a millimetre.
  void write_pair(const std::string& color,
                  const std::string& depth,
                  std::uint32_t frame,
                  double units = 1) const {
    write(color, encode_png(scene().colors[frame]));
    cv::Mat1f metres;
    scene().millimetres[frame].convertTo(metres, CV_32F, 0.001);
    write(depth, encode_depth_png(DepthImage(metres), 1000 * units));
  }
  void write_camera(const std::string& name, double depth_factor) const {
    CameraModel camera = scene().camera;
    camera.depth_factor = depth_factor;
    write(name, format_camera_yaml(camera));
  }
  [[nodiscard]] Trajectory run(const std::string& name, const std::string& format) const {
    return trajectory_of(base_.path() / name, format);
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return base_.path() / name; }

 private:
  TemporaryFolder base_;
};

// That of the folder in the layout of TUM.
const Trajectory& reference() {
  static const Trajectory kReference = [] {
    const Recordings all;
    std::string rgb, depth;
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      all.write_pair(fmt::format("tum/rgb/{}.png", i), fmt::format("tum/depth/{}.png", i), i, 5);
      rgb += fmt::format("{} rgb/{}.png\n", stamp(i), i);
      depth += fmt::format("{} depth/{}.png\n", stamp(i), i);
    }
    all.write("tum/rgb.txt", rgb);
    all.write("tum/depth.txt", depth);
    all.write_camera("tum/camera.yaml", 5000);
    return all.run("tum", "tum");
  }();
  return kReference;
}

class LayoutRun : public testing::Test {
 protected:
  Recordings all_;
};

TEST_F(LayoutRun, OfAListOfPairsAlone) {
  std::string pairs;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    all_.write_pair(fmt::format("pairs/c/{}.png", i), fmt::format("pairs/d/{}.png", i), i, 5);
    pairs += fmt::format("{0} c/{1}.png {0} d/{1}.png\n", stamp(i), i);
  }
  all_.write("pairs/associations.txt", pairs);
  all_.write_camera("pairs/camera.yaml", 5000);
  expect_same(all_.run("pairs", "tum"), reference(), kExact);
}

TEST_F(LayoutRun, OfBonn) {
  const std::string folder = "rgbd_bonn_synchronous/";
  std::string rgb, depth;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const std::string name = stamp(i) + ".png";
    all_.write_pair(folder + "rgb/" + name, folder + "depth/" + name, i, 5);
    rgb += fmt::format("{} rgb/{}\n", stamp(i), name);
    depth += fmt::format("{} depth/{}\n", stamp(i), name);
  }
  all_.write(folder + "rgb.txt", rgb);
  all_.write(folder + "depth.txt", depth);
  all_.write_camera(folder + "camera.yaml", 5000);
  expect_same(all_.run(folder, "tum"), reference(), kExact);
}

TEST_F(LayoutRun, OfIclNuim) {
  std::string pairs, poses;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    all_.write_pair(
        fmt::format("icl/rgb/{}.png", i + 1), fmt::format("icl/depth/{}.png", i + 1), i, 5);
    pairs += fmt::format("{0} depth/{0}.png {0} rgb/{0}.png\n", i + 1);
    poses += fmt::format("{} 0 0 0 0 0 0 1\n", i + 1);
  }
  all_.write("icl/associations.txt", pairs);
  all_.write("icl/livingRoom0.gt.freiburg", poses);
  all_.write_camera("icl/camera.yaml", 5000);
  expect_same(all_.run("icl", "icl"), reference(), kRounded);
}

TEST_F(LayoutRun, OfSevenScenes) {
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const std::string name = fmt::format("seq-01/frame-{:06}", i);
    all_.write_pair(name + ".color.png", name + ".depth.png", i);
    all_.write(name + ".pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  }
  all_.write_camera("seq-01/camera.yaml", 1000);
  expect_same(all_.run("seq-01", "7scenes"), reference(), kRounded);
}

TEST_F(LayoutRun, OfScanNet) {
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    all_.write_pair(fmt::format("scan/color/{}.png", i), fmt::format("scan/depth/{}.png", i), i);
    all_.write(fmt::format("scan/pose/{}.txt", i), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  }
  const CameraModel& c = scene().camera;
  all_.write("scan/intrinsic/intrinsic_depth.txt",
             fmt::format("{} 0 {} 0\n0 {} {} 0\n0 0 1 0\n0 0 0 1\n", c.fx, c.cx, c.fy, c.cy));
  expect_same(all_.run("scan", "scannet"), reference(), kRounded);
}

TEST_F(LayoutRun, OfOpen3dAndRedwood) {
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    all_.write_pair(
        fmt::format("o3d/color/{:06}.png", i), fmt::format("o3d/depth/{:06}.png", i), i);
  }
  const CameraModel& c = scene().camera;
  all_.write("o3d/camera_intrinsic.json",
             fmt::format(R"({{"width":{},"height":{},"intrinsic_matrix":[{},0,0,0,{},0,{},{},1]}})",
                         c.width_px,
                         c.height_px,
                         c.fx,
                         c.fy,
                         c.cx,
                         c.cy));
  expect_same(all_.run("o3d", "images"), reference(), kRounded);
}

TEST_F(LayoutRun, OfImagesThatAreNamedByTheirStamps) {
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    all_.write_pair("dump/rgb/" + stamp(i) + ".png", "dump/depth/" + stamp(i) + ".png", i);
  }
  all_.write_camera("dump/camera.yaml", 1000);
  expect_same(all_.run("dump", "images"), reference(), kExact);
}

// The same pairs in both layouts; depth is made of them, so that it is not that of the reference.
TEST_F(LayoutRun, OfEurocAndKitti) {
  const fs::path& euroc = scene().folder();
  std::string times;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const std::uint64_t ns =
        1'000'000'000'000U + static_cast<std::uint64_t>(std::llround(1e6 * i / 30.0)) * 1000U;
    for (const int camera : {0, 1}) {
      all_.write(fmt::format("kitti/image_{}/{:06}.png", camera + 2, i),
                 read_file(euroc / fmt::format("mav0/cam{}/data/{}.png", camera, ns), 10'000'000));
    }
    times += fmt::format("{:.6f}\n", i / 30.0);
  }
  all_.write("kitti/times.txt", times);
  const CameraModel& c = scene().camera;
  std::string calibration;
  for (const int camera : {0, 1, 2, 3}) {
    calibration += fmt::format("P{}: {} 0 {} {} 0 {} {} 0 0 0 1 0\n",
                               camera,
                               c.fx,
                               c.cx,
                               camera % 2 == 0 ? 0 : -c.fx * kBaselineM,
                               c.fy,
                               c.cy);
  }
  all_.write("kitti/calib.txt", calibration);
  const Trajectory of_euroc = trajectory_of(euroc, "euroc", "euroc");
  expect_same(all_.run("kitti", "kitti"), of_euroc, kRounded);
  // Nearly that of depth that was measured.
  expect_same(of_euroc, reference(), 0.03);
}

TEST_F(LayoutRun, OfAFileOfOpenNi) {
  OniWriter writer;
  const CameraModel& c = scene().camera;
  writer.add_stream(1, OniWriter::kColor, "NONE", {c.width_px, c.height_px});
  writer.add_stream(2, OniWriter::kDepth, "16zT", {c.width_px, c.height_px});
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const auto us = static_cast<std::uint64_t>(std::llround(1e6 * i / 30.0));
    const cv::Mat3b& color = scene().colors[i].mat;
    writer.image(1, us, {reinterpret_cast<const char*>(color.data), color.total() * 3});
    writer.image(2, us, encode_oni_depth(scene().millimetres[i], true));
  }
  writer.end();
  all_.write("scene.oni", writer.bytes());
  // Its axis is not in the middle of the image, as that of a field of view is.
  expect_same(trajectory_of(all_.path("scene.oni"), "oni", "", c), reference(), kExact);
}

#if STILLMAP_WITH_BAG_WRITER

TEST_F(LayoutRun, OfABagOfRos) {
  {
    BagWriter writer(all_.path("scene.bag").string());
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      const std::uint64_t ns =
          100'000'000'000U + static_cast<std::uint64_t>(std::llround(1e6 * i / 30.0)) * 1000U;
      writer.write("/camera/color/camera_info", ns, to_write(scene().camera));
      writer.write("/camera/color/image_raw", ns, to_write(scene().colors[i].mat, "rgb8"));
      writer.write("/camera/aligned_depth_to_color/image_raw",
                   ns,
                   to_write(scene().millimetres[i], "16UC1"));
    }
  }
  expect_same(all_.run("scene.bag", "rosbag"), reference(), kExact);
}

#endif

}  // namespace
}  // namespace stillmap
