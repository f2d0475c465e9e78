// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/tracking/tracked_frame.hpp"

namespace stillmap {

/// Tracked frames in which the network is still looking for objects.
class LateObjects {
 public:
  struct Awaiting {
    FramePtr frame;
    TrackedFrame tracked;
    std::size_t record;  ///< the frame's place in the session's frames
  };

  /// Frames come in order. When too many wait, the oldest is dropped.
  void await(Awaiting awaiting);

  /// Takes the frame whose objects have arrived and drops those before it. Nothing when the frame
  /// does not wait.
  [[nodiscard]] std::optional<Awaiting> take(FrameId frame);

 private:
  std::deque<Awaiting> awaiting_;
};

/// The frame as it would have been tracked with these masks: without the features on them, and
/// with its landmarks as the map has them now.
[[nodiscard]] TrackedFrame without_excluded_features(const TrackedFrame& tracked,
                                                     const Mask& excluded,
                                                     const Map& map,
                                                     const CameraModel& camera);

}  // namespace stillmap
