// SPDX-License-Identifier: Apache-2.0
// The client of rosbridge against a server on loopback.
#include "tooling/devices/rosbridge_device.hpp"

#include <chrono>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/devices/device_stream.hpp"
#include "tooling/devices/open_device.hpp"
#include "tooling/devices/stream_url.hpp"

#if STILLMAP_WITH_FAKE_ROSBRIDGE
#include "tests/support/rosbridge/fake_rosbridge.hpp"
#endif

namespace stillmap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(StreamUrl, IsReadByItsParts) {
  const auto parts = [](const std::string& text) {
    const StreamUrl url = parse_stream_url(text, "s");
    return url.host + " " + url.port + " " + url.target;
  };
  EXPECT_EQ(parts("ws://robot"), "robot 9090 /");
  EXPECT_EQ(parts("ws://robot:80/a/b?c=d"), "robot 80 /a/b?c=d");
  EXPECT_EQ(parts("ws://10.0.0.5/"), "10.0.0.5 9090 /");
  EXPECT_EQ(parts("ws://[fe80::1]:9091/x"), "fe80::1 9091 /x");
  EXPECT_EQ(parts("ws://robot?token=1"), "robot 9090 /?token=1");
  EXPECT_EQ(parse_stream_url("ws://[::1]", "s").authority(), "[::1]:9090");
  EXPECT_EQ(parse_stream_url("ws://robot:80", "s").authority(), "robot:80");
}

TEST(StreamUrl, OthersAreRefusedWithWhatIsOffered) {
  const auto error = [](const std::string& text) {
    return error_of([&] { (void)open_device("stream:" + text, {}); });
  };
  EXPECT_THAT(error("wss://robot:9090"),
              AllOf(StartsWith("stream:wss://robot:9090: encryption (wss) is not offered"),
                    HasSubstr("ssh -L")));
  for (const char* text : {"rtsp://camera/1", "http://camera", "https://camera", "udp://x"}) {
    EXPECT_THAT(error(text),
                AllOf(HasSubstr("is not offered, as video codecs carry no 16-bit depth"),
                      HasSubstr("expected stream:ws://HOST:PORT")));
  }
  for (const char* text : {"",
                           "robot:9090",
                           "ws://",
                           "ws://:9090",
                           "ws://robot:",
                           "ws://robot:0",
                           "ws://robot:65536",
                           "ws://robot:9090x",
                           "ws://[::1",
                           "ws://me@robot",
                           "ws://ro bot",
                           "ws://robot/\r\nHost: x"}) {
    EXPECT_THAT(error(text), HasSubstr("expected stream:ws://HOST:PORT, a robot's rosbridge"))
        << text;
  }
  EXPECT_THAT(error("ws://127.0.0.1:1"),
              HasSubstr(has_streams() ? "cannot be connected to (Connection refused)"
                                      : "install libboost-dev"));
}

#if STILLMAP_WITH_FAKE_ROSBRIDGE

using nlohmann::json;

class SteadyTestClock : public Clock {
 public:
  [[nodiscard]] double now_s() override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  void wait_until_s(double /*time_s*/) override {}
};

class Rosbridge : public testing::Test {
 protected:
  Rosbridge() {
    write_plane_sequence(folder_.path(), 6);
    wall_ = Sequence::open(folder_.path());
  }

  // Expects the frame of the folder, bit by bit.
  void expect_frame(const DeviceImages& images, std::uint32_t index) const {
    const FramePtr frame = wall_->read(FrameId(index));
    EXPECT_EQ(images.damage, "");
    EXPECT_NEAR(images.stamp_s, frame->stamp.seconds, 1e-9);
    EXPECT_NEAR(images.depth_stamp_s, frame->stamp.seconds, 1e-9);
    EXPECT_EQ(cv::norm(images.color.mat, frame->color.mat, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(images.depth.mat, frame->depth.mat, cv::NORM_INF), 0);
  }
  [[nodiscard]] static std::unique_ptr<Device> open(const FakeRosbridge& robot,
                                                    const DeviceRequest& request = {}) {
    return open_device("stream:" + robot.url(), request);
  }
  [[nodiscard]] static std::string error(const FakeRosbridge& robot,
                                         const DeviceRequest& request = {}) {
    return error_of([&] { (void)open(robot, request); });
  }
  [[nodiscard]] json color_sample() const {
    return image_value(wall_->read(FrameId(0))->color.mat, "rgb8", 5, BridgeCoding::kCbor);
  }
  [[nodiscard]] json depth_sample() const {
    return image_value(wall_->read(FrameId(0))->depth.mat, "32FC1", 5, BridgeCoding::kCbor);
  }

  TemporaryFolder folder_;
  std::optional<Sequence> wall_;
};

TEST_F(Rosbridge, GivesTheBitsOfTheSource) {
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    FakeRosbridge robot(coding);
    robot.add_camera(*wall_);
    const std::unique_ptr<Device> device = open(robot);
    EXPECT_EQ(device->name(), "stream:" + robot.url());
    EXPECT_THAT(device->warnings(), IsEmpty());
    ASSERT_TRUE(device->camera());
    EXPECT_EQ(device->camera()->fx, wall_->camera().fx);
    EXPECT_EQ(device->camera()->cy, wall_->camera().cy);
    EXPECT_EQ(device->camera()->width_px, 320);
    for (std::uint32_t i = 0; i < wall_->size(); ++i) {
      robot.publish_frame(*wall_, i);
      const std::optional<DeviceImages> images = device->wait(10);
      ASSERT_TRUE(images);
      expect_frame(*images, i);
    }
    EXPECT_FALSE(device->wait(0.01));
  }
}

TEST_F(Rosbridge, OfSeveralPairsGivesTheNewest) {
  FakeRosbridge robot(BridgeCoding::kCbor);
  robot.add_camera(*wall_);
  const std::unique_ptr<Device> device = open(robot);
  for (std::uint32_t i = 0; i < 6; ++i) robot.publish_frame(*wall_, i);
  std::optional<DeviceImages> images, last;
  std::size_t given = 0;
  while ((images = device->wait(1))) {
    EXPECT_TRUE(!last || images->stamp_s > last->stamp_s);
    last = std::move(images);
    ++given;
  }
  ASSERT_TRUE(last);
  EXPECT_LE(given, 6U);
  expect_frame(*last, 5);
}

// As a bag with these topics.
TEST_F(Rosbridge, FindsTopicsAsInBags) {
  FakeRosbridge robot(BridgeCoding::kCbor);
  const cv::Mat gray = wall_->read(FrameId(0))->gray.mat;
  robot.add_topic("/rosout", "rosgraph_msgs/Log", nullptr);
  robot.add_topic("/camera/infra1/image_raw",
                  "sensor_msgs/msg/Image",  // in the way of ROS 2
                  image_value(gray, "mono8", 5, BridgeCoding::kCbor));
  robot.add_topic("/camera/depth/image_raw", "sensor_msgs/msg/Image", depth_sample());
  robot.add_topic("/nobody/image_raw", "sensor_msgs/Image", nullptr);
  robot.add_topic("/broken/image_raw", "sensor_msgs/Image", {{"data", 5}});
  robot.add_camera(*wall_);
  const std::unique_ptr<Device> device = open(robot);
  robot.publish_frame(*wall_, 2);
  const std::optional<DeviceImages> images = device->wait(10);
  ASSERT_TRUE(images);
  expect_frame(*images, 2);
}

TEST_F(Rosbridge, TakesTheTopicsThatAreNamed) {
  FakeRosbridge robot(BridgeCoding::kJson);
  robot.add_camera(*wall_);
  robot.add_topic("/other/image", "sensor_msgs/Image", nullptr);
  const std::unique_ptr<Device> device = open(robot,
                                              {.camera = wall_->camera(),
                                               .color_topic = "/other/image",
                                               .depth_topic = FakeRosbridge::kDepthTopic});
  json content = color_sample();
  content["header"] = header_value(100'000'000'000U);
  robot.publish("/other/image", content);
  robot.publish_frame(*wall_, 0);
  const std::optional<DeviceImages> images = device->wait(10);
  ASSERT_TRUE(images);
  expect_frame(*images, 0);
  EXPECT_THAT(
      error(robot, {.color_topic = "/other/image", .depth_topic = FakeRosbridge::kDepthTopic}),
      HasSubstr("no CameraInfo of /other/image came; name the camera with --camera"));
  EXPECT_THAT(error(robot, {.color_topic = "/none", .depth_topic = FakeRosbridge::kDepthTopic}),
              HasSubstr("no topic /none with images; topics with images: /camera/color"));
}

TEST_F(Rosbridge, WithoutRosapiTopicsAreToBeNamed) {
  FakeRosbridge robot(BridgeCoding::kCbor, FakeRosbridge::Rosapi::kRefuses);
  robot.add_camera(*wall_);
  EXPECT_THAT(error(robot),
              HasSubstr("the robot's topics are not known, as its rosapi does not answer; name "
                        "them with --color-topic and --depth-topic"));
  const std::unique_ptr<Device> device =
      open(robot,
           {.color_topic = FakeRosbridge::kColorTopic, .depth_topic = FakeRosbridge::kDepthTopic});
  EXPECT_EQ(device->camera()->fx, wall_->camera().fx);  // from the topic beside that of colour
  robot.publish_frame(*wall_, 1);
  const std::optional<DeviceImages> images = device->wait(10);
  ASSERT_TRUE(images);
  expect_frame(*images, 1);
}

TEST_F(Rosbridge, SaysWhatItsCamerasLack) {
  const auto with_infos = [&](FakeRosbridge& robot, const json& color, const json& depth) {
    robot.add_topic(FakeRosbridge::kColorTopic, "sensor_msgs/Image", color_sample());
    robot.add_topic(FakeRosbridge::kDepthTopic, "sensor_msgs/Image", depth_sample());
    robot.add_topic("/camera/color/camera_info", "sensor_msgs/CameraInfo", color);
    robot.add_topic("/camera/aligned_depth_to_color/camera_info", "sensor_msgs/CameraInfo", depth);
  };
  const json info = info_value(wall_->camera());
  json other = info;
  other["K"][0] = 250;
  {
    FakeRosbridge robot(BridgeCoding::kCbor);
    with_infos(robot, info, other);
    EXPECT_THAT(open(robot)->warnings(), ElementsAre(HasSubstr("does not look registered")));
  }
  other["width"] = 640;
  {
    FakeRosbridge robot(BridgeCoding::kCbor);
    with_infos(robot, info, other);
    EXPECT_THAT(error(robot),
                HasSubstr("has 640x240 pixels, but /camera/color/image_raw has "
                          "320x240; expected depth that is registered"));
    CameraModel camera = wall_->camera();
    camera.depth_camera = std::make_shared<const DepthCamera>();
    EXPECT_THAT(open(robot, {.camera = camera})->warnings(), IsEmpty());
  }
  other = info;
  other["K"] = json(std::vector<double>(9, 0));
  FakeRosbridge robot(BridgeCoding::kCbor);
  with_infos(robot, other, info);
  EXPECT_THAT(error(robot), AllOf(HasSubstr("is not calibrated"), HasSubstr("--camera")));
  EXPECT_FALSE(open(robot, {.camera = wall_->camera()})->camera());
}

TEST_F(Rosbridge, ComesBackAfterTheConnectionWasLost) {
  FakeRosbridge robot(BridgeCoding::kCbor);
  robot.add_camera(*wall_);
  const std::unique_ptr<Device> device = open(robot);
  SteadyTestClock clock;
  std::vector<std::string> told;
  double told_after_s = 0, lost_at_s = 0;
  DeviceStream stream(*device,
                      clock,
                      {.camera = {},
                       .begin_s = 1000,
                       .stopped = [] { return false; },
                       .tell =
                           [&](const std::string& line) {
                             told.push_back(line);
                             if (told.size() > 1) return;
                             told_after_s = clock.now_s() - lost_at_s;
                             robot.come_up();
                             robot.publish_frame(*wall_, 3);
                           }});
  robot.publish_frame(*wall_, 0);
  ASSERT_TRUE(stream.next());
  robot.go_down();
  lost_at_s = clock.now_s();
  const std::optional<StreamedFrame> frame = stream.next();
  ASSERT_TRUE(frame);
  EXPECT_LE(told_after_s, 2);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_THAT(told[0], HasSubstr("gives no images; waiting for it"));
  EXPECT_THAT(told[1], HasSubstr("gives images again"));
  EXPECT_EQ(
      cv::norm(
          std::get<FramePtr>(*frame)->color.mat, wall_->read(FrameId(3))->color.mat, cv::NORM_INF),
      0);
}

TEST_F(Rosbridge, HostileMessagesAreDamagedFrames) {
  const json good = color_sample();
  const auto color_with = [&](const char* name, const json& value) {
    json content = good;
    content[name] = value;
    return encoded(published(FakeRosbridge::kColorTopic, content), BridgeCoding::kCbor);
  };
  const std::vector<std::pair<std::string, std::string>> messages = {
      {"no CBOR at all", "damaged CBOR"},
      {std::string(1'000'000, '\x81'), "too deep"},
      {std::string("\x5b\xff\xff\xff\xff\xff\xff\xff\xff"), "ends too early"},
      {color_with("header", 5), "without 'stamp'"},
      {color_with("height", -1), "'height' is no number"},
      {color_with("data", nullptr), "without bytes"},
      {std::string(65U << 20U, ' '), "more than 64 MiB"}};
  FakeRosbridge robot(BridgeCoding::kCbor);
  robot.add_camera(*wall_);
  const std::unique_ptr<Device> device = open(robot);
  std::uint32_t next = 0;
  for (const auto& [bytes, part] : messages) {
    robot.send_bytes(bytes, true);
    std::optional<DeviceImages> images = device->wait(20);
    ASSERT_TRUE(images) << part;
    EXPECT_THAT(images->damage, HasSubstr(part));
    // The next frame is whole. After a message that was too large the client has to come back.
    robot.publish_frame(*wall_, next % 6);
    for (int i = 0; i < 20 && !(images = device->wait(1)); ++i) {
      robot.publish_frame(*wall_, next % 6);
    }
    ASSERT_TRUE(images) << part;
    expect_frame(*images, next++ % 6);
  }
}

// An image that has a stamp is damaged at that stamp.
TEST_F(Rosbridge, SizesThatDoNotMatchAreDamage) {
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    FakeRosbridge robot(coding);
    robot.add_camera(*wall_);
    const std::unique_ptr<Device> device = open(robot);
    for (const auto& [name, value] : std::initializer_list<std::pair<const char*, json>>{
             {"height", 241}, {"width", 4'000'000'000U}, {"step", 959}, {"encoding", "yuv422"}}) {
      json content = color_sample();
      content["header"] = header_value(100'000'000'000U);
      content[name] = value;
      robot.publish(FakeRosbridge::kColorTopic, content);
      json depth = depth_sample();
      depth["header"] = content["header"];
      robot.publish(FakeRosbridge::kDepthTopic, depth);
      const std::optional<DeviceImages> images = device->wait(10);
      ASSERT_TRUE(images);
      EXPECT_NEAR(images->stamp_s, 100, 1e-9);
      EXPECT_THAT(images->damage, StartsWith("/camera/color/image_raw: ")) << name;
    }
  }
}

#endif

}  // namespace
}  // namespace stillmap
