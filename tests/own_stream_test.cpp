// SPDX-License-Identifier: Apache-2.0
// A sensor of one's own is one class: it gives frames, and the whole pipeline runs on them.
#include <memory>
#include <optional>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/sensor/frame_stream.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

constexpr int kFrames = 20;
constexpr double kFocal_px = 300, kWall_m = 1.5, kStep_px = 2;

// A camera slides along a painted wall, kStep_px pixels of its image a frame.
class SlidingCamera : public FrameStream {
 public:
  SlidingCamera() {
    camera_.name = "sliding";
    camera_.width_px = 320;
    camera_.height_px = 240;
    camera_.fx = camera_.fy = kFocal_px;
    camera_.cx = 160;
    camera_.cy = 120;
    cv::Mat3b tiles(24, 40);
    cv::RNG(7).fill(tiles, cv::RNG::UNIFORM, 0, 256);
    cv::resize(tiles, wall_, {}, 10, 10, cv::INTER_NEAREST);
  }
  [[nodiscard]] const CameraModel& camera() const override { return camera_; }
  [[nodiscard]] std::optional<StreamedFrame> next() override {
    if (next_ == kFrames) return std::nullopt;
    const auto frame = std::make_shared<RgbdFrame>();
    frame->id = FrameId(next_);
    frame->stamp = {next_ / 30.0, fmt::format("{:.6f}", next_ / 30.0)};
    frame->depth_stamp_s = frame->stamp.seconds;
    const int x_px = static_cast<int>(kStep_px * next_++);
    frame->color = ColorImage(wall_(cv::Rect(x_px, 0, 320, 240)).clone());
    frame->gray = to_gray(frame->color);
    frame->depth = DepthImage(cv::Mat1f(240, 320, static_cast<float>(kWall_m)));
    return frame;
  }

 private:
  CameraModel camera_;
  cv::Mat3b wall_;
  std::uint32_t next_ = 0;
};

TEST(FrameStream, OfOnesOwnIsTracked) {
  SlidingCamera camera;
  const SequenceRun run = run_sequence(camera, {}, {});
  ASSERT_EQ(run.result.trajectory.size(), std::size_t{kFrames});
  EXPECT_EQ(run.report.camera.name, "sliding");
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector3d expected(kStep_px * i * kWall_m / kFocal_px, 0, 0);
    const StampedPose& pose = run.result.trajectory[static_cast<std::size_t>(i)];
    // Before a plane alone, moving sideways looks nearly like turning.
    EXPECT_LT((pose.T_world_camera.translation() - expected).norm(), 0.02) << i;
  }
  EXPECT_GT(run.result.map.size(), 1000U);
}

}  // namespace
}  // namespace stillmap
