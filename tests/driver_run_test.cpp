// SPDX-License-Identifier: Apache-2.0
// Runs through drivers whose camera, kernel or robot a test plays: where no frame is dropped, the
// trajectory is that of the folder that the images come from.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <opencv2/core.hpp>

#include "tests/support/fake_device.hpp"
#include "tests/support/fake_video.hpp"
#include "tests/support/live_runs.hpp"
#include "tooling/devices/device_stream.hpp"
#include "tooling/devices/open_device.hpp"
#include "tooling/devices/v4l2_device.hpp"

#if STILLMAP_WITH_FAKE_ROSBRIDGE
#include "tests/support/rosbridge/fake_rosbridge.hpp"
#endif

namespace stillmap {
namespace {

/// Has each frame of the wall happen when it is waited for; time passes with it.
class WallDevice : public Device {
 public:
  WallDevice(Device& device, SharedClock& clock, std::function<void(std::uint32_t)> happen)
      : device_(device), clock_(clock), happen_(std::move(happen)) {}

  [[nodiscard]] const std::string& name() const override { return device_.name(); }
  [[nodiscard]] std::optional<CameraModel> camera() const override { return device_.camera(); }
  [[nodiscard]] bool ended() const override { return next_ == kWallFrames; }
  [[nodiscard]] std::optional<DeviceImages> wait(double /*timeout_s*/) override {
    constexpr double kPatienceS = 30;
    if (ended()) return std::nullopt;
    happen_(next_++);
    clock_.pass_s(kWallPeriod_s);
    return device_.wait(kPatienceS);
  }

 private:
  Device& device_;
  SharedClock& clock_;
  std::function<void(std::uint32_t)> happen_;
  std::uint32_t next_ = 0;
};

SequenceRun run_of(FrameStream& frames) {
  RunOptions options;
  options.threads = 1;
  return run_sequence(frames, {}, std::move(options));
}

// The run on the device, whose frames `happen` brings about.
SequenceRun run_on(Device& device,
                   SharedClock& clock,
                   std::optional<CameraModel> camera,
                   std::function<void(std::uint32_t)> happen) {
  WallDevice wall(device, clock, std::move(happen));
  DeviceStream frames(wall,
                      clock,
                      {.camera = std::move(camera),
                       .begin_s = wall_sequence().entry(FrameId(0)).stamp.seconds,
                       .stopped = [] { return false; },
                       .tell = [](const std::string&) {}});
  return run_of(frames);
}

void expect_trajectory_of_folder(const SequenceRun& run) {
  SequenceStream folder(wall_sequence());
  const Trajectory expected = run_of(folder).result.trajectory;
  const Trajectory& actual = run.result.trajectory;
  ASSERT_EQ(expected.size(), kWallFrames);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(actual[i].stamp.seconds, expected[i].stamp.seconds, 1e-9);
    const Eigen::Matrix4d off =
        actual[i].T_world_camera.matrix() - expected[i].T_world_camera.matrix();
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-9) << i;
  }
}

std::vector<std::uint8_t> bytes_of(const cv::Mat& pixels) {
  return {pixels.data, pixels.data + pixels.total() * pixels.elemSize()};
}

TEST(DriverRun, OfVideoNodesHasTheTrajectoryOfTheFolder) {
  SharedClock clock;
  FakeVideo video(clock);
  const cv::Size size(320, 240);
  video.nodes["c"] = {
      .formats = {{V4L2_PIX_FMT_YUYV, {size, {640, 480}}}, {V4L2_PIX_FMT_RGB24, {size}}}};
  video.nodes["d"] = {.formats = {{V4L2_PIX_FMT_Z16, {size, {640, 480}}}}};
  // Its unit is that of the folder: 5000 a metre.
  const CameraModel& camera = wall_sequence().camera();
  ASSERT_EQ(camera.depth_factor, 5000);
  const std::unique_ptr<Device> device =
      open_v4l2_device("c,d", "v4l2:c,d", {.camera = camera}, video);
  const SequenceRun run = run_on(*device, clock, camera, [&](std::uint32_t i) {
    const FramePtr frame = wall_sequence().read(FrameId(i));
    cv::Mat1w units;
    frame->depth.mat.convertTo(units, CV_16U, 5000);
    const double stamp_s = frame->stamp.seconds;
    video.events.push_back({.node = "d", .stamp_s = stamp_s, .bytes = bytes_of(units)});
    video.events.push_back({.node = "c", .stamp_s = stamp_s, .bytes = bytes_of(frame->color.mat)});
  });
  expect_trajectory_of_folder(run);
}

#if STILLMAP_WITH_FAKE_ROSBRIDGE

// In the middle the connection is lost, and comes back.
TEST(DriverRun, OfARobotHasTheTrajectoryOfTheFolder) {
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    SharedClock clock;
    FakeRosbridge robot(coding);
    robot.add_camera(wall_sequence());
    const std::unique_ptr<Device> device = open_device("stream:" + robot.url(), {});
    const SequenceRun run = run_on(*device, clock, {}, [&](std::uint32_t i) {
      if (i == kWallFrames / 2) {
        robot.go_down();
        robot.come_up();
      }
      robot.publish_frame(wall_sequence(), i);
    });
    expect_trajectory_of_folder(run);
  }
}

#endif

}  // namespace
}  // namespace stillmap
