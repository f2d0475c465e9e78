// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/tum_sequence.hpp"

#include <memory>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/files.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

CameraModel small_camera() {
  CameraModel camera;
  camera.name = "small";
  camera.width_px = 8;
  camera.height_px = 6;
  camera.fx = camera.fy = 10;
  camera.cx = 4;
  camera.cy = 3;
  camera.depth_factor = 1000;
  return camera;
}

// A sequence of two frames of 8x6 pixels, to be spoilt by the tests.
class TumSequenceTest : public ::testing::Test {
 protected:
  TumSequenceTest() : folder_(base_.path() / "sequence") {
    fs::create_directories(folder_ / "rgb");
    fs::create_directories(folder_ / "depth");
    write("rgb.txt", "# colour\n10.000 rgb/a.png\r\n\n10.10 rgb/b.jpg\n");
    write("depth.txt", "10.005 depth/a.png\n10.095 depth/b.png\n");
    write("camera.yaml", format_camera_yaml(small_camera()));
    const ColorImage red(cv::Mat3b(6, 8, cv::Vec3b(200, 10, 20)));
    write("rgb/a.png", encode_png(red));
    const std::vector<std::uint8_t> jpeg = encode_jpeg(red, 95);
    write("rgb/b.jpg", std::string(jpeg.begin(), jpeg.end()));
    write("depth/a.png", encode_depth_png(DepthImage(cv::Mat1f(6, 8, 1.5F)), 1000));
    write("depth/b.png", encode_depth_png(DepthImage(cv::Mat1f(6, 8, 2.5F)), 1000));
  }

  void write(const std::string& name, std::string_view bytes) const {
    write_file_atomically(folder_ / name, bytes);
  }

  [[nodiscard]] std::string open_error() const {
    return error_of([&] { (void)TumSequence::open(folder_); });
  }

  [[nodiscard]] std::string read_error() const {
    return error_of([&] { (void)TumSequence::open(folder_).read(FrameId(0)); });
  }

  TemporaryFolder base_;
  fs::path folder_;
};

TEST_F(TumSequenceTest, ReadsFrames) {
  const TumSequence sequence = TumSequence::open(folder_);
  EXPECT_EQ(sequence.name(), "sequence");
  EXPECT_EQ(sequence.camera().name, "small");
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.entry(FrameId(1)).color_file, folder_ / "rgb/b.jpg");
  EXPECT_FALSE(sequence.groundtruth_file());

  const FramePtr frame = sequence.read(FrameId(0));
  EXPECT_EQ(frame->id, FrameId(0));
  EXPECT_EQ(frame->stamp.text, "10.000");
  EXPECT_EQ(frame->stamp.seconds, 10.0);
  EXPECT_EQ(frame->depth_stamp_s, 10.005);
  EXPECT_EQ(frame->color.mat(5, 7), cv::Vec3b(200, 10, 20));
  EXPECT_EQ(frame->gray.mat(5, 7), 68);  // 0.299 * 200 + 0.587 * 10 + 0.114 * 20 = 67.95
  EXPECT_EQ(frame->depth.mat(5, 7), 1.5F);
  EXPECT_EQ(sequence.read(FrameId(1))->depth.mat(0, 0), 2.5F);
  EXPECT_THROW((void)sequence.read(FrameId(2)), InternalError);
}

TEST_F(TumSequenceTest, ReadsFramesInThreads) {
  const TumSequence sequence = TumSequence::open(folder_);
  std::vector<FramePtr> frames(40);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < frames.size(); i += 4) {
          frames[i] = sequence.read(FrameId(static_cast<std::uint32_t>(i % 2)));
        }
      });
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(frames[i]->id.index(), i % 2);
    ASSERT_EQ(cv::norm(frames[i]->color.mat, frames[i % 2]->color.mat, cv::NORM_INF), 0.0);
    ASSERT_EQ(cv::norm(frames[i]->depth.mat, frames[i % 2]->depth.mat, cv::NORM_INF), 0.0);
  }
}

TEST_F(TumSequenceTest, PairsTheNearestStampsOnceAndWithin20Milliseconds) {
  write("rgb.txt", "1.000 rgb/a\n1.010 rgb/b\n2.000 rgb/c\n3.000 rgb/d\n");
  write("depth.txt", "0.985 depth/a\n1.008 depth/b\n2.021 depth/c\n3.000 depth/d\n");
  const TumSequence sequence = TumSequence::open(folder_);
  ASSERT_EQ(sequence.size(), 3U);
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_file, folder_ / "depth/a");
  EXPECT_EQ(sequence.entry(FrameId(1)).depth_file, folder_ / "depth/b");
  EXPECT_EQ(sequence.entry(FrameId(2)).stamp.text, "3.000");
}

TEST_F(TumSequenceTest, TakesTheAssociationsWhereTheyAre) {
  write("associations.txt",
        "10.0 rgb/a.png 10.095 depth/b.png\n10.100000 rgb/b.jpg 10.095 depth/b.png\n");
  const TumSequence sequence = TumSequence::open(folder_);
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_file, folder_ / "depth/b.png");
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_stamp_s, 10.095);
  EXPECT_EQ(sequence.entry(FrameId(0)).stamp.text, "10.000");  // as rgb.txt writes it
  EXPECT_EQ(sequence.entry(FrameId(1)).stamp.text, "10.10");
}

TEST_F(TumSequenceTest, ChoosesTheCamera) {
  SequenceOptions options;
  options.camera = builtin_camera("bonn");
  EXPECT_EQ(TumSequence::open(folder_, options).camera().name, "bonn");
  EXPECT_EQ(TumSequence::open(folder_).camera().name, "small");

  fs::create_directories(folder_ / "truth");
  write("truth/objects.json", R"({"camera":{"width":8,"height":6,"fx":9,"fy":9,"cx":4,"cy":3}})");
  fs::remove(folder_ / "camera.yaml");
  EXPECT_EQ(TumSequence::open(folder_).camera().fx, 9.0);
  fs::remove_all(folder_ / "truth");
  EXPECT_THAT(open_error(), HasSubstr("put a camera.yaml there"));
  fs::create_directories(folder_ / "truth");
  write("truth/objects.json", R"({"camera":{"width":8,"height":6,"fx":9,"fy":9,"cx":4,"cy":3}})");
  for (const auto& [name, camera] : {std::pair("rgbd_dataset_freiburg1_xyz", "tum_fr1"),
                                     std::pair("TUM-FR2-desk", "tum_fr2"),
                                     std::pair("freiburg3_walking", "tum_fr3"),
                                     std::pair("rgbd_bonn_crowd", "bonn"),
                                     std::pair("fr12_bonnet", "truth")}) {
    fs::rename(folder_, base_.path() / name);
    EXPECT_EQ(TumSequence::open(base_.path() / name / "").camera().name, camera) << name;
    fs::rename(base_.path() / name, folder_);
  }
}

TEST_F(TumSequenceTest, FindsTheGroundTruth) {
  write("groundtruth.txt", "");
  EXPECT_EQ(TumSequence::open(folder_).groundtruth_file(), folder_ / "groundtruth.txt");
}

TEST_F(TumSequenceTest, RefusesBadLists) {
  EXPECT_THAT(error_of([&] { (void)TumSequence::open(base_.path() / "none"); }),
              HasSubstr("none: no such folder"));
  write("rgb.txt", "# nothing\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt: the list is empty"));
  write("rgb.txt", "10.0 rgb/a.png\n10.0 rgb/b.jpg\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("rgb.txt:2"), HasSubstr("10.0 does not come after")));
  write("rgb.txt", "10.0 rgb/a.png\n9.0 rgb/b.jpg\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt:2"));
  write("rgb.txt", "nan rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt:1: column 1 is 'nan'"));
  write("rgb.txt", "../x rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("finite number"));
  write("rgb.txt", "10.0\n");
  EXPECT_THAT(open_error(), HasSubstr("1 columns, expected 2"));
  write("rgb.txt", "20.0 rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("within 0.02 s"));
  fs::remove(folder_ / "rgb.txt");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt is missing"));
}

TEST_F(TumSequenceTest, RefusesFilesOutsideOfTheFolder) {
  for (const char* file : {"/etc/passwd", "../x.png", "rgb/../../x.png", "rgb/.."}) {
    write("rgb.txt", fmt::format("10.0 rgb/a.png\n10.1 {}\n", file));
    EXPECT_THAT(open_error(), AllOf(HasSubstr("rgb.txt:2"), HasSubstr("out of the sequence")));
  }
  write("rgb.txt", "10.0 rgb/a..b.png\n");
  EXPECT_EQ(TumSequence::open(folder_).size(), 1U);
  write("associations.txt", "10.0 rgb/a.png 10.0 /dev/zero\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("associations.txt:1"), HasSubstr("/dev/zero")));
}

TEST_F(TumSequenceTest, RefusesBadImages) {
  write("rgb/a.png", encode_png(ColorImage(cv::Mat3b(6, 9, cv::Vec3b(1, 2, 3)))));
  EXPECT_THAT(read_error(),
              AllOf(HasSubstr("a.png: 9x6 pixels, expected 8x6"), HasSubstr("small")));
  write("rgb/a.png", "junk");
  EXPECT_THAT(read_error(), HasSubstr("rgb/a.png"));
  fs::remove(folder_ / "rgb/a.png");
  EXPECT_THAT(read_error(), HasSubstr("rgb/a.png"));
  write("rgb/a.png", encode_png(ColorImage(cv::Mat3b(6, 8, cv::Vec3b(1, 2, 3)))));
  write("depth/a.png", encode_png(ColorImage(cv::Mat3b(6, 8, cv::Vec3b(1, 2, 3)))));
  EXPECT_THAT(read_error(), AllOf(HasSubstr("depth/a.png"), HasSubstr("16-bit")));
}

TEST(TumSequenceOnData, OpensTheSharedSequences) {
  STILLMAP_NEED_SHARED_DATA("twin_walking_xyz");
  const fs::path data = shared_data("");
  const TumSequence twin = TumSequence::open(data / "twin_walking_xyz");
  EXPECT_EQ(twin.size(), 300U);
  EXPECT_EQ(twin.camera().fx, 535.4);
  const TumSequence walkers = TumSequence::open(data / "fr1_xyz_walkers");
  EXPECT_EQ(walkers.size(), 358U);
  EXPECT_EQ(walkers.camera().name, "tum_fr1");
  const TumSequence fr1 = TumSequence::open(data / "tum_fr1_xyz_360");
  EXPECT_GT(fr1.size(), 300U);
  const FramePtr frame = fr1.read(FrameId(0));
  EXPECT_EQ(frame->stamp.text, "1305031102.175304");
  EXPECT_EQ(frame->depth.mat.cols, 640);
}

}  // namespace
}  // namespace stillmap
