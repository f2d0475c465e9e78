// SPDX-License-Identifier: Apache-2.0
// Bags that the library of ROS 1 writes give the bits of the folder whose frames they hold.
#include "tooling/recordings/ros_bag.hpp"

#include <cmath>
#include <cstring>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/recordings/bag_file.hpp"
#include "tooling/recordings/recording_formats.hpp"

#if STILLMAP_WITH_BAG_WRITER
#include "tests/support/bags/bag_messages.hpp"
#endif

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(RosBagFile, IsRecognised) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  write_file_atomically(path, "#ROSBAG V2.0\n nothing more");
  EXPECT_TRUE(is_ros_bag(path));
  EXPECT_FALSE(is_ros_bag(folder.path()));
  EXPECT_THAT(
      error_of([&] { (void)open_ros_bag(path, {}); }),
      HasSubstr(has_bag_library() ? "a.bag: no readable bag" : "install librosbag-storage-dev"));
  write_file_atomically(path, "#ROS");
  EXPECT_FALSE(is_ros_bag(path));
}

#if STILLMAP_WITH_BAG_WRITER

std::uint64_t nanoseconds(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds * 1e6)) * 1000U;
}

class RosBag : public testing::Test {
 protected:
  RosBag() {
    write_plane_sequence(base_.path() / "wall", 5);
    wall_ = Sequence::open(base_.path() / "wall");
    info_ = to_write(wall_->camera());
  }

  [[nodiscard]] FramePtr frame(std::uint32_t i) const { return wall_->read(FrameId(i)); }
  [[nodiscard]] std::uint64_t stamp_ns(std::uint32_t i) const {
    return nanoseconds(wall_->entry(FrameId(i)).stamp.seconds);
  }
  [[nodiscard]] fs::path bag() const { return base_.path() / "wall.bag"; }
  [[nodiscard]] Sequence open(ReadingOptions reading = {}) const {
    return Sequence::open(bag(), {.reading = std::move(reading), .formats = recording_formats()});
  }

  // Expects the frames of the folder, bit by bit.
  void expect_wall(const Sequence& sequence) const {
    EXPECT_EQ(sequence.format(), "rosbag");
    EXPECT_EQ(sequence.camera().fx, wall_->camera().fx);
    EXPECT_EQ(sequence.camera().cy, wall_->camera().cy);
    ASSERT_EQ(sequence.size(), wall_->size());
    for (std::uint32_t i = 0; i < sequence.size(); ++i) {
      const FramePtr a = frame(i), b = sequence.read(FrameId(i));
      EXPECT_NEAR(a->stamp.seconds, b->stamp.seconds, 1e-9);
      EXPECT_EQ(b->stamp.text, a->stamp.text + "000");
      EXPECT_EQ(cv::norm(a->color.mat, b->color.mat, cv::NORM_INF), 0.0);
      EXPECT_EQ(cv::norm(a->depth.mat, b->depth.mat, cv::NORM_INF), 0.0);
    }
  }

  TemporaryFolder base_;
  std::optional<Sequence> wall_;
  InfoToWrite info_;
};

TEST_F(RosBag, GivesTheBitsOfTheFolder) {
  for (const BagWriter::Compression compression : {BagWriter::Compression::kNone,
                                                   BagWriter::Compression::kLz4,
                                                   BagWriter::Compression::kBz2}) {
    {
      BagWriter writer(bag().string(), compression);
      for (std::uint32_t i = 0; i < wall_->size(); ++i) {
        cv::Mat1w millimetres;
        frame(i)->depth.mat.convertTo(millimetres, CV_16U, 1000);
        writer.write("/camera/rgb/camera_info", stamp_ns(i), info_);
        writer.write("/camera/rgb/image_color", stamp_ns(i), to_write(frame(i)->color.mat, "rgb8"));
        writer.write(
            "/camera/depth_registered/image_raw", stamp_ns(i), to_write(millimetres, "16UC1"));
        writer.write("/camera/ir/image", stamp_ns(i), to_write(frame(i)->gray.mat, "mono8"));
      }
    }
    const Sequence sequence = open();
    expect_wall(sequence);
    EXPECT_THAT(
        sequence.remarks().notes,
        ElementsAre("colour /camera/rgb/image_color, depth /camera/depth_registered/image_raw"));
  }
}

TEST_F(RosBag, ReadsTheTopicsOfRealSense) {
  {
    BagWriter writer(bag().string());
    writer.write_number("/device_0/sensor_0/option/Depth Units/value", stamp_ns(0), 0.0001F);
    for (std::uint32_t i = 0; i < wall_->size(); ++i) {
      cv::Mat1w units;
      frame(i)->depth.mat.convertTo(units, CV_16U, 10000);
      writer.write("/device_0/sensor_1/Color_0/info/camera_info", stamp_ns(i), info_);
      writer.write("/device_0/sensor_0/Depth_0/info/camera_info", stamp_ns(i), info_);
      writer.write("/device_0/sensor_1/Color_0/image/data",
                   stamp_ns(i),
                   to_write(frame(i)->color.mat, "rgb8"));
      writer.write("/device_0/sensor_0/Depth_0/image/data", stamp_ns(i), to_write(units, "mono16"));
      writer.write("/device_0/sensor_0/Infrared_1/image/data",
                   stamp_ns(i),
                   to_write(frame(i)->gray.mat, "mono8"));
    }
  }
  const Sequence sequence = open();
  expect_wall(sequence);
  EXPECT_TRUE(sequence.remarks().warnings.empty());
}

TEST_F(RosBag, ReadsCompressedColorFloatDepthAndAnyOrder) {
  {
    BagWriter writer(bag().string());
    writer.write("/camera/rgb/camera_info", stamp_ns(0), info_);
    for (const std::uint32_t i : {1U, 0U, 2U, 4U, 3U, 3U}) {
      const std::string png = encode_png(frame(i)->color);
      writer.write_compressed("/camera/rgb/image_color/compressed",
                              stamp_ns(i),
                              "rgb8; png compressed bgr8",
                              {png.begin(), png.end()});
      writer.write("/camera/depth/image", stamp_ns(i), to_write(frame(i)->depth.mat, "32FC1"));
    }
  }
  const Sequence sequence = open();
  expect_wall(sequence);
  EXPECT_THAT(sequence.remarks().warnings,
              testing::Contains(HasSubstr("1 images have the stamp of another")));

  std::vector<FramePtr> frames(40);  // the library reads for one thread at a time
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < frames.size(); i += 4)
          frames[i] = sequence.read(FrameId(static_cast<std::uint32_t>(i % 5)));
      });
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(cv::norm(frames[i]->color.mat,
                       frame(static_cast<std::uint32_t>(i % 5))->color.mat,
                       cv::NORM_INF),
              0.0);
  }
}

TEST_F(RosBag, SaysWhatIsMissingOrDamaged) {
  const ImageToWrite color = to_write(frame(0)->color.mat, "rgb8");
  const ImageToWrite depth = to_write(frame(0)->depth.mat, "32FC1");
  const auto write = [&](const ImageToWrite& color_image, const ImageToWrite& depth_image) {
    BagWriter writer(bag().string());
    writer.write("/rgb/image", stamp_ns(0), color_image);
    writer.write("/depth/image", stamp_ns(0), depth_image);
  };
  const auto error = [&] { return error_of([&] { (void)open(); }); };
  write(color, depth);
  EXPECT_THAT(error(), HasSubstr("which camera took it is unknown (no CameraInfo for /rgb/image)"));
  SequenceOptions options{.camera = wall_->camera(), .formats = recording_formats()};
  EXPECT_EQ(Sequence::open(bag(), options).size(), 1U);
  options.reading.depth_topic = "/rgb/image";
  EXPECT_THAT(error_of([&] { (void)Sequence::open(bag(), options); }),
              HasSubstr("/rgb/image, frame 0: encoding 'rgb8'"));
  write(color, to_write(cv::Mat1f(100, 200, 1.0F), "32FC1"));
  EXPECT_THAT(error(), HasSubstr("/depth/image: 200x100 pixels, but /rgb/image has 320x240"));
  write(color, color);
  EXPECT_THAT(
      error(),
      HasSubstr("no topic with depth images; topics with images: /depth/image, /rgb/image"));

  write(color, depth);
  const std::string whole = read_file(bag(), 10'000'000);
  for (const std::size_t size :
       {whole.size() / 2, whole.size() - 1, std::size_t{4200}, std::size_t{20}}) {
    write_file_atomically(bag(), whole.substr(0, size));
    EXPECT_THAT(error(), HasSubstr("wall.bag")) << size;
  }
}

TEST_F(RosBag, ADamagedImageIsADamagedFrame) {
  {
    BagWriter writer(bag().string());
    for (std::uint32_t i = 0; i < wall_->size(); ++i) {
      ImageToWrite color = to_write(frame(i)->color.mat, "rgb8");
      if (i == 2) color.bytes.resize(1000);
      writer.write("/rgb/camera_info", stamp_ns(i), info_);
      writer.write("/rgb/image", stamp_ns(i), color);
      writer.write("/depth/image", stamp_ns(i), to_write(frame(i)->depth.mat, "32FC1"));
    }
  }
  SequenceStream stream(open());
  for (std::uint32_t i = 0; i < wall_->size(); ++i) {
    const std::optional<StreamedFrame> next = stream.next();
    ASSERT_TRUE(next);
    EXPECT_EQ(std::holds_alternative<DamagedFrame>(*next), i == 2);
  }
}

#endif

}  // namespace
}  // namespace stillmap
