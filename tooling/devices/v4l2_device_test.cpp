// SPDX-License-Identifier: Apache-2.0
// The driver of video nodes against a kernel that the test plays.
#include "tooling/devices/v4l2_device.hpp"

#include <cmath>
#include <fstream>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/io/jpeg_codec.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/fake_device.hpp"
#include "tests/support/fake_video.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/devices/device_stream.hpp"
#include "tooling/devices/open_device.hpp"
#include "tooling/devices/video_modes.hpp"
#include "tooling/devices/video_node.hpp"

namespace stillmap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kColor = "/dev/video4";
constexpr const char* kDepth = "/dev/video2";
const cv::Size kSmall(8, 6);

Bytes bytes_of(const cv::Mat& pixels) {
  return {pixels.data, pixels.data + pixels.total() * pixels.elemSize()};
}

CameraModel video_camera() {
  CameraModel camera;
  camera.name = "small";
  camera.width_px = kSmall.width;
  camera.height_px = kSmall.height;
  camera.fx = camera.fy = 10;
  camera.cx = 3.5;
  camera.cy = 2.5;
  camera.depth_factor_given = false;
  return camera;
}

// Nodes as those of a RealSense D435, with small images.
class V4l2 : public testing::Test {
 protected:
  V4l2() {
    video_.nodes[kColor] = {.formats = {{V4L2_PIX_FMT_RGB24, {kSmall}}}};
    video_.nodes[kDepth] = {.formats = {{V4L2_PIX_FMT_Z16, {kSmall}}}};
    video_.nodes["/dev/video5"] = {.formats = {}, .can = V4L2_CAP_META_CAPTURE};
  }
  ~V4l2() override {
    EXPECT_EQ(video_.opened, 0);
    EXPECT_EQ(video_.mapped, 0);
  }

  void image(const char* node, double after_s, double stamp_s, Bytes bytes) {
    FakeVideo::Event event{.after_s = after_s, .node = node};
    event.stamp_s = stamp_s;
    event.bytes = std::move(bytes);
    video_.events.push_back(std::move(event));
  }
  // Colour and depth of one moment, and of one value each.
  void pair(double after_s, double stamp_s, std::uint8_t gray = 7, std::uint16_t unit = 1500) {
    image(kColor, after_s, stamp_s, Bytes(8 * 6 * 3, gray));
    image(kDepth, 0, stamp_s + 0.002, bytes_of(cv::Mat1w(kSmall, unit)));
  }
  void plug(double after_s, FakeVideo::Event::What what) {
    for (const char* node : {kColor, kDepth}) {
      video_.events.push_back({.after_s = after_s, .node = node, .what = what});
      after_s = 0;
    }
  }
  [[nodiscard]] std::unique_ptr<Device> open(const DeviceRequest& request = {}) {
    return open_v4l2_device(std::string(kColor) + "," + kDepth, "v4l2:c,d", request, video_);
  }
  [[nodiscard]] std::string error() {
    return error_of([&] { (void)open(); });
  }

  SharedClock clock_;
  FakeVideo video_{clock_};
};

TEST_F(V4l2, GivesTheBitsOfPairs) {
  cv::Mat3b rgb(kSmall);
  cv::Mat1w units(kSmall);
  cv::RNG rng(5);
  rng.fill(rgb, cv::RNG::UNIFORM, 0, 256);
  rng.fill(units, cv::RNG::UNIFORM, 0, 65536);
  units(0, 0) = 0;
  units(0, 1) = 65535;
  units(0, 2) = 1500;
  image(kColor, 0.1, 100.25, bytes_of(rgb));
  image(kDepth, 0.001, 100.252, bytes_of(units));
  const std::unique_ptr<Device> device = open({.camera = video_camera()});
  EXPECT_EQ(device->name(), "v4l2:c,d");
  EXPECT_FALSE(device->camera());
  EXPECT_THAT(device->warnings(), ElementsAre(HasSubstr("does not register its depth")));
  EXPECT_EQ(device->choice(), "colour RGB3 8x6, depth Z16 8x6");
  const std::optional<DeviceImages> images = device->wait(1);
  ASSERT_TRUE(images);
  EXPECT_EQ(images->damage, "");
  EXPECT_NEAR(images->stamp_s, 100.25, 1e-9);
  EXPECT_NEAR(images->depth_stamp_s, 100.252, 1e-9);
  EXPECT_EQ(cv::norm(images->color.mat, rgb, cv::NORM_INF), 0);
  EXPECT_EQ(images->depth.mat(0, 0), 0);
  EXPECT_EQ(images->depth.mat(0, 1), 0);
  EXPECT_EQ(images->depth.mat(0, 2), 1.5F);  // millimetres
  EXPECT_EQ(images->depth.mat(3, 4), static_cast<float>(units(3, 4)) / 1000.F);
  EXPECT_FALSE(device->wait(0.1));
}

TEST_F(V4l2, TheCameraSaysTheUnitAndTheSizes) {
  video_.nodes[kColor].formats[0].sizes = {{640, 480}, kSmall, {1280, 720}};
  video_.nodes[kDepth].formats[0].sizes = {{4, 3}, {640, 480}};
  CameraModel camera = video_camera();
  camera.depth_factor = 10000;
  camera.depth_factor_given = true;
  DepthCamera depth_camera{video_camera(), Eigen::Isometry3d::Identity()};
  depth_camera.camera.width_px = 4;
  depth_camera.camera.height_px = 3;
  camera.depth_camera = std::make_shared<const DepthCamera>(depth_camera);
  image(kColor, 0.1, 5, Bytes(8 * 6 * 3, 1));
  image(kDepth, 0, 5, bytes_of(cv::Mat1w(3, 4, std::uint16_t{15000})));
  const std::unique_ptr<Device> device = open({.camera = camera});
  EXPECT_THAT(device->warnings(), IsEmpty());
  const std::optional<DeviceImages> images = device->wait(1);
  ASSERT_TRUE(images);
  EXPECT_EQ(images->color.mat.size(), kSmall);
  EXPECT_EQ(images->depth.mat.size(), cv::Size(4, 3));
  EXPECT_EQ(images->depth.mat(1, 1), 1.5F);
}

TEST_F(V4l2, OfSeveralPairsGivesTheNewest) {
  pair(0.1, 1.0, 1);
  pair(0, 1.033, 2);
  pair(0, 1.066, 3);
  const std::unique_ptr<Device> device = open();
  // The first image wakes it, the others are there at that moment.
  std::optional<DeviceImages> images, last;
  while ((images = device->wait(0.25))) last = std::move(images);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->color.mat(0, 0), cv::Vec3b(3, 3, 3));
}

// BT.601, as cameras send it: the formulas of the standard, rounded.
TEST_F(V4l2, ConvertsColor) {
  const auto expected = [](double y, double u, double v) {
    const double l = 1.164383562 * (y - 16);
    const auto byte = [](double value) {
      return static_cast<int>(std::lround(std::clamp(value, 0.0, 255.0)));
    };
    return cv::Vec3i(byte(l + 1.596026786 * (v - 128)),
                     byte(l - 0.391762290 * (u - 128) - 0.812967647 * (v - 128)),
                     byte(l + 2.017232143 * (u - 128)));
  };
  cv::RNG rng(9);
  for (int i = 0; i < 200; ++i) {
    const int y0 = rng.uniform(16, 236), y1 = rng.uniform(16, 236), u = rng.uniform(16, 240),
              v = rng.uniform(16, 240);
    const auto b = [](int value) { return static_cast<std::uint8_t>(value); };
    const RawVideo yuyv{0, {b(y0), b(u), b(y1), b(v)}}, uyvy{0, {b(u), b(y0), b(v), b(y1)}};
    const cv::Mat3b a = video_color(yuyv, {V4L2_PIX_FMT_YUYV, {2, 1}, 4}, "n").mat;
    const cv::Mat3b c = video_color(uyvy, {V4L2_PIX_FMT_UYVY, {2, 1}, 4}, "n").mat;
    EXPECT_LE(cv::norm(cv::Vec3i(a(0, 0)) - expected(y0, u, v), cv::NORM_INF), 1);
    EXPECT_LE(cv::norm(cv::Vec3i(a(0, 1)) - expected(y1, u, v), cv::NORM_INF), 1);
    EXPECT_EQ(cv::norm(a, c, cv::NORM_INF), 0);
  }
  const RawVideo gray{0, {10, 20, 0, 30, 40}};
  EXPECT_EQ(video_color(gray, {V4L2_PIX_FMT_GREY, {2, 2}, 3}, "n").mat(1, 1),
            cv::Vec3b(40, 40, 40));
  const cv::Mat3b rgb(16, 16, cv::Vec3b(200, 100, 50));
  const RawVideo jpeg{0, encode_jpeg_bytes(rgb, 95)};
  EXPECT_LE(
      cv::norm(video_color(jpeg, {V4L2_PIX_FMT_MJPEG, {16, 16}, 0}, "n").mat, rgb, cv::NORM_INF),
      3);
}

TEST_F(V4l2, ShortAndDamagedBuffersAreDamagedFrames) {
  video_.nodes[kColor].row_padding = 8;
  const std::size_t whole = 32 * 5 + 24;  // the padding of the last row may be missing
  image(kColor, 0.1, 1.0, Bytes(whole, 1));
  image(kDepth, 0, 1.0, Bytes(8 * 6 * 2, 1));
  image(kColor, 0.1, 1.1, Bytes(whole - 1, 1));
  image(kDepth, 0, 1.1, Bytes(8 * 6 * 2, 1));
  image(kColor, 0.1, 1.2, Bytes(whole, 1));
  image(kDepth, 0, 1.2, {});
  image(kColor, 0.1, 1.3, Bytes(whole, 1));
  video_.events.back().flags |= V4L2_BUF_FLAG_ERROR;
  image(kDepth, 0, 1.3, Bytes(8 * 6 * 2, 1));
  image(kColor, 0.1, 1.4, Bytes(100'000, 1));  // more than the buffer has
  image(kDepth, 0, 1.4, Bytes(8 * 6 * 2, 1));
  const std::unique_ptr<Device> device = open();
  std::vector<std::string> damages;
  while (const std::optional<DeviceImages> images = device->wait(0.3)) {
    damages.push_back(images->damage);
  }
  EXPECT_THAT(damages,
              ElementsAre("",
                          "/dev/video4: 183 bytes in rows of 32, expected 8x6 pixels of RGB3",
                          "/dev/video2: 0 bytes in rows of 16, expected 8x6 pixels of Z16",
                          "/dev/video4: an image that the driver calls damaged",
                          ""));
}

TEST_F(V4l2, ADamagedImageIsADamagedFrameOfTheStream) {
  pair(0.1, 1.0);
  image(kColor, 0.1, 1.1, Bytes(10, 1));
  image(kDepth, 0, 1.1, Bytes(8 * 6 * 2, 1));
  pair(0.1, 1.2);
  const std::unique_ptr<Device> device = open({.camera = video_camera()});
  DeviceStream stream(*device,
                      clock_,
                      {.camera = video_camera(),
                       .begin_s = 1000,
                       .stopped = [&] { return video_.events.empty(); },
                       .tell = [](const std::string&) {}});
  EXPECT_TRUE(std::holds_alternative<FramePtr>(*stream.next()));
  EXPECT_THAT(std::get<DamagedFrame>(*stream.next()).damage,
              HasSubstr("v4l2:c,d: /dev/video4: 10 bytes"));
}

// The whole way of a camera that stalls, is unplugged and comes back.
TEST_F(V4l2, IsWaitedForAndOpenedAgain) {
  pair(0.1, 1.0);
  pair(5, 6.0);
  plug(0.1, FakeVideo::Event::What::kUnplugged);
  plug(4, FakeVideo::Event::What::kPluggedIn);
  pair(0.5, 0.5);
  pair(0.1, 0.6);
  std::vector<std::string> told;
  std::vector<double> told_at_s, stamps;
  const std::unique_ptr<Device> device = open({.camera = video_camera()});
  DeviceStream stream(*device,
                      clock_,
                      {.camera = video_camera(),
                       .begin_s = 1000,
                       .stopped = [&] { return stamps.size() == 4; },
                       .tell =
                           [&](const std::string& line) {
                             told.push_back(line);
                             told_at_s.push_back(clock_.now_s());
                           }});
  double last_image_s = 0;
  while (const std::optional<StreamedFrame> frame = stream.next()) {
    stamps.push_back(stamp_of(*frame).seconds);
    if (stamps.size() == 2) last_image_s = clock_.now_s();
  }
  ASSERT_EQ(stamps.size(), 4U);
  EXPECT_NEAR(stamps[1], 1005, 1e-6);
  EXPECT_NEAR(stamps[2], 1009.6, 1e-6);  // by our clock, as the camera's began anew
  EXPECT_NEAR(stamps[3], 1009.7, 1e-6);
  ASSERT_EQ(told.size(), 4U);
  EXPECT_EQ(told[1], "v4l2:c,d gives images again, after 5.0 s");
  EXPECT_THAT(told[2], HasSubstr("gives no images; waiting"));
  EXPECT_LE(told_at_s[2] - last_image_s, 2);
  EXPECT_EQ(told[3], "v4l2:c,d gives images again, after 4.6 s");
}

TEST_F(V4l2, OneNodeAloneIsRefused) {
  const auto error = [&](const std::string& which) {
    return error_of([&] { (void)open_v4l2_device(which, "v4l2:" + which, {}, video_); });
  };
  EXPECT_EQ(error("/dev/video2"),
            "v4l2:/dev/video2: gives depth alone; name the node of colour, too: "
            "v4l2:COLOR,/dev/video2");
  EXPECT_EQ(error("/dev/video4"),
            "v4l2:/dev/video4: gives colour alone, without depth; name the node of depth, too: "
            "v4l2:/dev/video4,DEPTH");
  EXPECT_THAT(error("/dev/video5"), HasSubstr("/dev/video5 takes no images"));
  EXPECT_THAT(error("/dev/video9"), HasSubstr("cannot be opened: No such file"));
  EXPECT_THAT(error("/dev/video2,/dev/video4"),
              HasSubstr("/dev/video2 gives no colour, but Z16 8x6; expected v4l2:COLOR,DEPTH"));
  EXPECT_THAT(error("/dev/video4,/dev/video4"), HasSubstr("gives no depth (Z16), but RGB3 8x6"));
  for (const char* which : {"", ",", "/dev/video4,", "a,b,c"}) {
    EXPECT_THAT(error(which), HasSubstr("expected v4l2:COLOR,DEPTH")) << which;
  }
}

TEST_F(V4l2, DriversThatGiveSomethingElseAreRefused) {
  video_.nodes[kColor].given_format = V4L2_PIX_FMT_YUYV;
  EXPECT_EQ(error(), "v4l2:c,d: /dev/video4 gives YUYV of 8x6 pixels, asked for RGB3 of 8x6");
  video_.nodes[kColor].given_format.reset();
  video_.nodes[kDepth].given_size = {4, 3};
  EXPECT_THAT(error(), HasSubstr("/dev/video2 gives Z16 of 4x3 pixels, asked for Z16 of 8x6"));
  video_.nodes[kDepth].given_size.reset();
  video_.nodes[kDepth].formats[0].sizes = {{4, 3}};
  EXPECT_THAT(error(),
              HasSubstr("does not have one size up to 640x480 of both; /dev/video4 has RGB3 8x6; "
                        "/dev/video2 has Z16 4x3"));
  EXPECT_THAT(error_of([&] { (void)open({.camera = video_camera()}); }),
              HasSubstr("the sizes of the camera, 8x6 of colour and 8x6 of depth"));
}

TEST(VideoModes, AreTheLargestThatBothHaveAt30Hz) {
  const auto z16 = [](int width, int height, double rate_hz) {
    return VideoMode{V4L2_PIX_FMT_Z16, {width, height}, rate_hz};
  };
  const auto color = [](std::uint32_t format, int width, int height, double rate_hz) {
    return VideoMode{format, {width, height}, rate_hz};
  };
  const std::vector<VideoMode> depths = {
      z16(1280, 720, 30), z16(848, 480, 30), z16(640, 480, 30), z16(424, 240, 30)};
  const std::vector<VideoMode> colors = {color(V4L2_PIX_FMT_MJPEG, 640, 480, 30),
                                         color(V4L2_PIX_FMT_YUYV, 640, 480, 30),
                                         color(V4L2_PIX_FMT_YUYV, 1280, 720, 30),
                                         color(V4L2_PIX_FMT_YUYV, 424, 240, 30)};
  auto chosen = choose_video_modes(colors, depths, {});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->first.size, cv::Size(640, 480));
  EXPECT_EQ(chosen->first.format, static_cast<std::uint32_t>(V4L2_PIX_FMT_YUYV));
  EXPECT_EQ(chosen->second.size, cv::Size(640, 480));
  // A smaller size at 30 Hz comes before a larger one at 6 Hz, but not before none.
  chosen = choose_video_modes(
      {color(V4L2_PIX_FMT_YUYV, 640, 480, 6), color(V4L2_PIX_FMT_YUYV, 424, 240, 30)}, depths, {});
  EXPECT_EQ(chosen->second.size, cv::Size(424, 240));
  chosen = choose_video_modes({color(V4L2_PIX_FMT_YUYV, 640, 480, 6)}, depths, {});
  EXPECT_EQ(chosen->second.size, cv::Size(640, 480));
  chosen = choose_video_modes(colors, depths, {cv::Size(1280, 720), cv::Size(848, 480)});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->first.size, cv::Size(1280, 720));
  EXPECT_EQ(chosen->second.size, cv::Size(848, 480));
  EXPECT_FALSE(choose_video_modes(colors, {z16(1280, 720, 30)}, {}));
  EXPECT_FALSE(choose_video_modes(depths, depths, {}));
}

// The calls of this machine, on what is no video node.
TEST(LinuxVideo, RefusesOtherFiles) {
  EXPECT_THAT(error_of([] { (void)open_v4l2_device("/dev/null", "v4l2:/dev/null", {}); }),
              HasSubstr("/dev/null is no video node"));
  EXPECT_THAT(error_of([] { (void)open_v4l2_device("/dev/none", "v4l2:/dev/none", {}); }),
              HasSubstr("cannot be opened: No such file"));
}

}  // namespace
}  // namespace stillmap
