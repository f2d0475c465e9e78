// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap {

/// Finds the objects of frames and follows them. The objects of a frame are returned some frames
/// later, because later frames show which objects the network has missed.
class ObjectSource {
 public:
  /// `segmenter` may be null: then every frame is returned at once, without objects. It outlives
  /// the object.
  ObjectSource(const Segmenter* segmenter, const ObjectTrackerConfig& config);

  /// Whether there is a network that finds objects.
  [[nodiscard]] bool has_network() const { return segmenter_ != nullptr; }

  /// Takes the next frame; returns the objects of the frames that are complete, in order, each
  /// once.
  [[nodiscard]] std::vector<FrameObjects> push(const RgbdFrame& frame);

  /// Ends the stream: returns the objects of the remaining frames.
  [[nodiscard]] std::vector<FrameObjects> flush();

 private:
  const Segmenter* segmenter_;
  ObjectTracker tracker_;
};

}  // namespace stillmap
