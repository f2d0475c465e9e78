// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/ros_message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/image_io.hpp"
#include "stillmap/io/png_codec.hpp"
#include "tests/support/files.hpp"
#include "tooling/ros/camera_info.hpp"
#include "tooling/ros/ros_image.hpp"
#include "tooling/ros/ros_topics.hpp"

namespace stillmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

template <class Number>
std::string bytes_of(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

std::string text_of(const std::string& text) {
  return bytes_of(static_cast<std::uint32_t>(text.size())) + text;
}

std::string header() {
  return bytes_of(std::uint32_t{7}) + bytes_of(std::uint32_t{100}) + bytes_of(std::uint32_t{5}) +
         text_of("camera");
}

// Two rows of three pixels, by the definition of sensor_msgs/Image.
std::string image(const std::string& encoding, std::uint32_t row_bytes, const std::string& pixels) {
  return header() + bytes_of(std::uint32_t{2}) + bytes_of(std::uint32_t{3}) + text_of(encoding) +
         '\0' + bytes_of(row_bytes) + text_of(pixels);
}

TEST(RosMessage, IsReadByItsDefinition) {
  const std::string pixels = "abcdefghi-jklmnopqr-";
  const std::string message = image("rgb8", 10, pixels);
  const RosImage read = parse_ros_image(message, "t");
  EXPECT_EQ(read.stamp.seconds, 100U);
  EXPECT_EQ(read.stamp.nanoseconds, 5U);
  EXPECT_EQ(read.height_px, 2U);
  EXPECT_EQ(read.width_px, 3U);
  EXPECT_EQ(read.encoding, "rgb8");
  EXPECT_EQ(read.row_bytes, 10U);
  EXPECT_EQ(read.pixels, pixels);
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_THROW((void)parse_ros_image(message.substr(0, size), "t"), DamagedImage) << size;
  }
}

TEST(RosImage, DecodesColor) {
  const std::string pixels = "abcdefghi-jklmnopqr-";
  const auto decoded =
      [&](const char* encoding, std::uint32_t row_bytes, const std::string& bytes) {
        return decode_ros_color(image(encoding, row_bytes, bytes), RosImageType::kPlain, "t").mat;
      };
  EXPECT_EQ(decoded("rgb8", 10, pixels)(1, 2), cv::Vec3b('p', 'q', 'r'));
  EXPECT_EQ(decoded("bgr8", 10, pixels)(1, 2), cv::Vec3b('r', 'q', 'p'));
  EXPECT_EQ(decoded("mono8", 3, "abcdef")(1, 0), cv::Vec3b('d', 'd', 'd'));
  EXPECT_EQ(decoded("bgra8", 12, "abcdefghijklmnopqrstuvwx")(0, 1), cv::Vec3b('g', 'f', 'e'));
  const auto error = [&](const char* encoding, std::uint32_t row_bytes, const std::string& bytes) {
    return error_of([&] { (void)decoded(encoding, row_bytes, bytes); });
  };
  EXPECT_THAT(error("rgb8", 10, pixels.substr(0, 18)),
              HasSubstr("t: 18 bytes, expected 3x2 pixels of rgb8"));
  EXPECT_THAT(error("rgb8", 8, pixels), HasSubstr("expected 3x2 pixels"));
  EXPECT_THAT(error("rgb8", 0xFFFFFFFFU, pixels), HasSubstr("expected 3x2 pixels"));
  EXPECT_THAT(error("yuv422", 6, pixels), HasSubstr("encoding 'yuv422', expected rgb8"));
  EXPECT_THAT(error("16UC1", 6, pixels), HasSubstr("expected rgb8"));
}

TEST(RosImage, DecodesDepth) {
  std::string units, metres;
  for (const std::uint16_t value : {0, 1500, 65535, 1, 2, 3}) units += bytes_of(value);
  for (const float value : {0.0F, 1.5F, NAN, -1.0F, INFINITY, 0.25F}) metres += bytes_of(value);
  const cv::Mat1f a =
      decode_ros_depth(image("16UC1", 6, units), RosImageType::kPlain, 1000, "t").mat;
  EXPECT_EQ(a(0, 0), 0.0F);
  EXPECT_EQ(a(0, 1), 1.5F);
  EXPECT_EQ(a(0, 2), 0.0F);
  EXPECT_EQ(a(1, 2), 0.003F);
  const cv::Mat1f b =
      decode_ros_depth(image("32FC1", 12, metres), RosImageType::kPlain, 1000, "t").mat;
  EXPECT_EQ(b(0, 1), 1.5F);
  EXPECT_EQ(b(0, 2), 0.0F);
  EXPECT_EQ(b(1, 0), 0.0F);
  EXPECT_EQ(b(1, 1), 0.0F);
  EXPECT_EQ(b(1, 2), 0.25F);
  EXPECT_EQ(ros_image_kind(image("32FC1", 12, metres), RosImageType::kPlain, "t"),
            RosImageKind::kDepth);

  // As compressed_depth_image_transport stores it: 2 m with the constants 1000 and 5 is 505.
  cv::Mat1w stored(2, 3, std::uint16_t{0});
  stored(0, 1) = 505;
  const std::string file =
      bytes_of(std::uint32_t{0}) + bytes_of(1000.0F) + bytes_of(5.0F) + encode_png_bytes(stored);
  for (const auto& [format, expected] : {std::pair("32FC1; compressedDepth", 2.0F),
                                         std::pair("16UC1; compressedDepth png", 0.505F)}) {
    const std::string message = header() + text_of(format) + text_of(file);
    EXPECT_EQ(ros_image_kind(message, RosImageType::kCompressed, "t"), RosImageKind::kDepth);
    const cv::Mat1f depth = decode_ros_depth(message, RosImageType::kCompressed, 1000, "t").mat;
    EXPECT_FLOAT_EQ(depth(0, 1), expected);
    EXPECT_EQ(depth(1, 1), 0.0F);
  }
}

RosCameraInfo info() {
  RosCameraInfo info;
  info.width_px = 640;
  info.height_px = 480;
  info.distortion_model = "plumb_bob";
  info.distortion = {0.1, -0.2, 0.003, 0.004, 0.5};
  info.intrinsics = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  info.projection = {480, 0, 310, 0, 0, 490, 230, 0, 0, 0, 1, 0};
  return info;
}

TEST(CameraInfo, GivesTheCamera) {
  const CameraModel raw = camera_of_info(info(), false, "t");
  EXPECT_EQ(raw.fy, 510);
  EXPECT_EQ(raw.cx, 320);
  EXPECT_EQ(raw.p2, 0.004);
  EXPECT_EQ(raw.k3, 0.5);
  EXPECT_EQ(raw.depth_factor, 1000);
  const CameraModel rectified = camera_of_info(info(), true, "t");
  EXPECT_EQ(rectified.fx, 480);
  EXPECT_EQ(rectified.cy, 230);
  EXPECT_FALSE(rectified.distorted());
  RosCameraInfo other = info();
  other.distortion_model = "of glass";
  EXPECT_THAT(error_of([&] { (void)camera_of_info(other, false, "t"); }),
              AllOf(StartsWith("t:"), HasSubstr("of glass")));
  other.distortion_model = "equidistant";
  other.distortion = {0.1, 0.2, 0.3, 0.4};
  EXPECT_EQ(camera_of_info(other, false, "t").lens, LensModel::kFisheye);
  EXPECT_EQ(camera_of_info(other, false, "t").k4, 0.4);
  other.distortion = {0, 0, 0, 0};
  EXPECT_FALSE(camera_of_info(other, false, "t").distorted());
  other = info();
  other.distortion_model = "rational_polynomial";
  other.distortion.resize(8, 0);
  EXPECT_EQ(camera_of_info(other, false, "t").k2, -0.2);
  other.distortion[7] = 0.1;
  EXPECT_EQ(camera_of_info(other, false, "t").k6, 0.1);
  other.distortion.resize(15, 1);
  EXPECT_THAT(error_of([&] { (void)camera_of_info(other, false, "t"); }), StartsWith("t:"));
  other = info();
  other.intrinsics = {};
  EXPECT_THAT(error_of([&] { (void)camera_of_info(other, false, "t"); }),
              HasSubstr("not calibrated"));
}

TEST(RosTopics, AreChosenByWhatTheyShow) {
  const std::vector<ImageTopic> topics = {
      {"/camera/infra1/image_rect_raw", RosImageType::kPlain, RosImageKind::kGray},
      {"/camera/color/image_raw/compressed", RosImageType::kCompressed, RosImageKind::kColor},
      {"/camera/color/image_raw", RosImageType::kPlain, RosImageKind::kColor},
      {"/camera/depth/image_rect_raw", RosImageType::kPlain, RosImageKind::kDepth},
      {"/camera/aligned_depth_to_color/image_raw", RosImageType::kPlain, RosImageKind::kDepth}};
  EXPECT_EQ(choose_color_topic(topics, "", "b").name, "/camera/color/image_raw");
  EXPECT_EQ(choose_depth_topic(topics, "", "b").name, "/camera/aligned_depth_to_color/image_raw");
  EXPECT_EQ(choose_depth_topic(topics, "/camera/depth/image_rect_raw", "b").name,
            "/camera/depth/image_rect_raw");
  EXPECT_THAT(error_of([&] { (void)choose_color_topic(topics, "/nothing", "b"); }),
              HasSubstr("b: no topic /nothing with images"));
  EXPECT_THAT(error_of([&] { (void)choose_depth_topic({topics[0]}, "", "b"); }),
              HasSubstr("no topic with depth images"));
  const std::vector<ImageTopic> two = {{"/a", RosImageType::kPlain, RosImageKind::kDepth},
                                       {"/b", RosImageType::kPlain, RosImageKind::kDepth}};
  EXPECT_THAT(error_of([&] { (void)choose_depth_topic(two, "", "b"); }),
              HasSubstr("--depth-topic: /a, /b"));

  const std::vector<std::string> infos = {"/camera/depth/camera_info", "/camera/color/camera_info"};
  EXPECT_EQ(info_topic_of("/camera/color/image_raw", infos), infos[1]);
  EXPECT_EQ(info_topic_of("/camera/other/image_raw", infos), "");
  EXPECT_EQ(info_topic_of("/device_0/sensor_1/Color_0/image/data",
                          {"/device_0/sensor_0/Depth_0/info/camera_info",
                           "/device_0/sensor_1/Color_0/info/camera_info"}),
            "/device_0/sensor_1/Color_0/info/camera_info");
}

}  // namespace
}  // namespace stillmap
