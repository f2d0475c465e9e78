// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap {

/// A frame with the objects that a network has found in it, or has missed and others remember.
struct FrameWithObjects {
  FramePtr frame;
  FrameObjects objects;
};

/// Finds the objects of frames and follows them. A frame comes out some frames after it went in,
/// because later frames say what it misses.
class ObjectSource {
 public:
  /// `segmenter` may be null: then frames come out at once, without objects. It outlives this.
  ObjectSource(const Segmenter* segmenter, const ObjectTrackerConfig& config);

  /// Whether there is something that finds objects.
  [[nodiscard]] bool looks() const { return segmenter_ != nullptr; }

  /// Takes the next frame; gives those that are ready, in order.
  [[nodiscard]] std::vector<FrameWithObjects> push(FramePtr frame);

  /// The end: the frames that have not come out.
  [[nodiscard]] std::vector<FrameWithObjects> flush();

 private:
  [[nodiscard]] FrameWithObjects pair_up(FrameObjects objects);

  const Segmenter* segmenter_;
  ObjectTracker tracker_;
  std::deque<FramePtr> waiting_;
};

}  // namespace stillmap
