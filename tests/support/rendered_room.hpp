// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/synth/sequence.hpp"

namespace stillmap {

/// The rendered office without people, as seen by a hand-held Kinect with a quarter of the pixels.
/// A frame is rendered at its first use.
class RenderedRoom {
 public:
  explicit RenderedRoom(std::uint32_t frames, PathKind path = PathKind::kXyz)
      : sequence_(options(frames, path)), frames_(frames) {}

  [[nodiscard]] const SyntheticSequence& sequence() const { return sequence_; }
  [[nodiscard]] const CameraModel& camera() const { return sequence_.camera(); }
  [[nodiscard]] Eigen::Isometry3d pose(std::uint32_t k) const { return sequence_.pose(FrameId(k)); }

  [[nodiscard]] FramePtr frame(std::uint32_t k) const {
    if (!frames_.at(k)) frames_[k] = sequence_.frame(FrameId(k));
    return frames_[k];
  }

  /// The frame with a black image and no depth.
  [[nodiscard]] FramePtr dark_frame(std::uint32_t k) const {
    RgbdFrame dark;
    dark.id = FrameId(k);
    dark.stamp = sequence_.stamp(dark.id);
    const cv::Size size(camera().width_px, camera().height_px);
    dark.color = ColorImage(cv::Mat3b(size, cv::Vec3b(0, 0, 0)));
    dark.gray = GrayImage(cv::Mat1b(size, std::uint8_t{0}));
    dark.depth = DepthImage(cv::Mat1f(size, 0.0F));
    return std::make_shared<const RgbdFrame>(std::move(dark));
  }

 private:
  [[nodiscard]] static SyntheticOptions options(std::uint32_t frames, PathKind path) {
    SyntheticOptions options;
    options.camera = synthetic_camera(320, 240);
    options.path = path;
    options.frames = frames;
    return options;
  }

  SyntheticSequence sequence_;
  mutable std::vector<FramePtr> frames_;
};

inline constexpr std::uint32_t kRoomFrames = 60;

/// The room of most tests: `kRoomFrames` long.
inline const RenderedRoom& empty_room() {
  static const RenderedRoom kRoom(kRoomFrames);
  return kRoom;
}

}  // namespace stillmap
