// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap {

/// Finds the objects of one frame after another with a network and gives them identities over
/// frames. No frame waits for a later one: objects that the network misses are filled in from the
/// frames before (Fan 2020, section III-C, in one direction).
///
///   ObjectFinder objects(make_segmenter("auto", {640, 480}));
///   FrameResult result = slam.process(frame, objects.find(frame));
class ObjectFinder {
 public:
  /// Throws Error where `network` is null.
  explicit ObjectFinder(std::shared_ptr<const Segmenter> network);
  /// The moved-from finder may only be assigned to or destroyed.
  /// @{
  ObjectFinder(ObjectFinder&&) noexcept;
  ObjectFinder& operator=(ObjectFinder&&) noexcept;
  /// @}
  ~ObjectFinder();

  /// The objects of a frame. Frames come in the order of their stamps. Throws what the network
  /// throws.
  [[nodiscard]] FrameObjects find(const RgbdFrame& frame);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace stillmap
