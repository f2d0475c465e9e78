// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/recording_stream.hpp"

#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/sensor/sequence_stream.hpp"
#include "stillmap/sensor/stamps.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CameraModel odd_camera() {
  CameraModel camera;
  camera.name = "odd";
  camera.width_px = 37;
  camera.height_px = 23;
  camera.fx = 30.1;
  camera.fy = 29.7;
  camera.cx = 18.2;
  camera.cy = 11.3;
  camera.depth_factor = 1000;
  return camera;
}

/// Frames that a test has made.
class Given : public FrameStream {
 public:
  explicit Given(std::vector<StreamedFrame> frames) : frames_(std::move(frames)) {}
  [[nodiscard]] const CameraModel& camera() const override { return camera_; }
  [[nodiscard]] std::optional<StreamedFrame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }

 private:
  CameraModel camera_ = odd_camera();
  std::vector<StreamedFrame> frames_;
  std::size_t next_ = 0;
};

FramePtr noisy_frame(std::uint32_t id, const Stamp& stamp) {
  cv::RNG rng(id + 1);
  cv::Mat3b color(23, 37);
  cv::Mat1f depth(23, 37);
  rng.fill(color, cv::RNG::UNIFORM, 0, 256);
  rng.fill(depth, cv::RNG::UNIFORM, 0.3, 9.0);  // no whole millimetres
  depth(0, 0) = 0;
  depth(0, 1) = 70;  // beyond 16 bits
  RgbdFrame frame = make_frame(stamp.seconds, ColorImage(color), DepthImage(depth));
  frame.id = FrameId(id);
  frame.stamp = stamp;
  frame.depth_stamp_s = stamp.seconds + 0.0012345;
  return std::make_shared<const RgbdFrame>(std::move(frame));
}

std::vector<FramePtr> frames_of(FrameStream& stream) {
  std::vector<FramePtr> frames;
  while (std::optional<StreamedFrame> frame = stream.next()) {
    frames.push_back(std::get<FramePtr>(*frame));
  }
  return frames;
}

void expect_same_frames(const std::vector<FramePtr>& a, const std::vector<FramePtr>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i]->id, b[i]->id);
    EXPECT_EQ(a[i]->stamp.text, b[i]->stamp.text);
    EXPECT_EQ(a[i]->stamp.seconds, b[i]->stamp.seconds);
    EXPECT_EQ(a[i]->depth_stamp_s, b[i]->depth_stamp_s);
    EXPECT_EQ(cv::norm(a[i]->color.mat, b[i]->color.mat, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(a[i]->depth.mat, b[i]->depth.mat, cv::NORM_INF), 0);
  }
}

TEST(RecordingStream, PassesOnWhatIsReadFromTheRecording) {
  const TemporaryFolder folder;
  std::vector<StreamedFrame> frames;
  const double begin_s = 1341846313.592026;
  for (std::uint32_t i = 0; i < 5; ++i) {
    // A text without all digits of the number, and ids that begin late and have gaps.
    frames.emplace_back(noisy_frame(10 + 2 * i, stamp_of_seconds(begin_s + i / 30.0)));
  }
  frames.insert(frames.begin() + 2,
                DamagedFrame{FrameId(13), stamp_of_seconds(begin_s + 0.05), "torn"});
  Given given(frames);
  RecordingStream recording(given, folder.path() / "kept");
  const std::vector<FramePtr> passed = frames_of(recording);
  EXPECT_EQ(recording.frames(), 5U);
  EXPECT_THAT(recording.warnings(), ElementsAre(HasSubstr("1 damaged frames")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "kept" / "rgb.txt"));
  recording.finish();
  EXPECT_EQ(passed[1]->depth.mat(0, 1), 0);
  EXPECT_NEAR(passed[1]->depth.mat(5, 5), noisy_frame(12, {})->depth.mat(5, 5), 0.0005001);

  SequenceStream kept(Sequence::open(folder.path() / "kept"));
  EXPECT_EQ(kept.camera().fx, odd_camera().fx);
  EXPECT_EQ(kept.camera().depth_factor, 1000);
  expect_same_frames(passed, frames_of(kept));
}

TEST(RecordingStream, KeepsTheTextsOfStampsInSecondsAlone) {
  const TemporaryFolder folder;
  Given given({noisy_frame(0, {1.5, "1.50"}), noisy_frame(1, {1.75, "1750000000"})});
  RecordingStream recording(given, folder.path() / "kept");
  const std::vector<FramePtr> passed = frames_of(recording);
  recording.finish();
  EXPECT_EQ(passed[0]->stamp.text, "1.50");
  EXPECT_EQ(passed[1]->stamp.text, "1.750000");
  SequenceStream kept(Sequence::open(folder.path() / "kept"));
  expect_same_frames(passed, frames_of(kept));
}

TEST(RecordingStream, WritesIntoANewFolderAlone) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "mine.txt") << "mine";
  Given given({});
  EXPECT_THAT(error_of([&] { RecordingStream recording(given, folder.path()); }),
              HasSubstr("is not empty"));
}

TEST(RecordingStream, LeavesNothingWhereItWasNotFinished) {
  const TemporaryFolder folder;
  {
    Given given({noisy_frame(0, {1.5, "1.5"})});
    RecordingStream recording(given, folder.path() / "kept");
    (void)frames_of(recording);
  }
  EXPECT_TRUE(!std::filesystem::exists(folder.path() / "kept") ||
              std::filesystem::is_empty(folder.path() / "kept"));
}

TEST(RecordingStream, EndsWithAnErrorWhereTheDiskIsFull) {
  const TemporaryFolder folder;
  std::vector<StreamedFrame> frames;
  for (std::uint32_t i = 0; i < 100; ++i) frames.emplace_back(noisy_frame(i, stamp_of_seconds(i)));
  Given given(frames);
  RecordingStream recording(given, folder.path() / "kept");
  const FileSizeLimit full(1000);
  EXPECT_THAT(error_of([&] {
                (void)frames_of(recording);
                recording.finish();
              }),
              HasSubstr("kept"));
}

}  // namespace
}  // namespace stillmap
