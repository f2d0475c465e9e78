// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap {

/// Finds the objects of frames and follows them. The objects of a frame come out some frames after
/// it went in, because later frames tell which objects the network has missed in it.
class ObjectSource {
 public:
  /// `segmenter` may be null: then every frame comes out at once and has no objects. It outlives
  /// this.
  ObjectSource(const Segmenter* segmenter, const ObjectTrackerConfig& config);

  /// Whether there is a network that finds objects.
  [[nodiscard]] bool has_network() const { return segmenter_ != nullptr; }

  /// Takes the next frame; gives the objects of those frames that are ready, in order, each frame
  /// once.
  [[nodiscard]] std::vector<FrameObjects> push(const RgbdFrame& frame);

  /// The end: the objects of the frames that have not come out.
  [[nodiscard]] std::vector<FrameObjects> flush();

 private:
  const Segmenter* segmenter_;
  ObjectTracker tracker_;
};

}  // namespace stillmap
