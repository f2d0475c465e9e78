// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// The same object in all frames that have it.
using TrackId = Id<struct TrackTag>;

/// Where the pixels of an object come from.
enum class MaskSource : std::uint8_t {
  kDetected,  ///< the network, in this very frame; there may be none
  kCarried,   ///< the nearest frame that has the object, refined by depth
  kBox,       ///< its box, all of it
};

/// The frames that the box of an object comes from which was not detected itself.
struct BoxOrigin {
  std::optional<FrameId> before;
  std::optional<FrameId> after;

  bool operator==(const BoxOrigin&) const = default;
};

/// An object of a frame, with its identity.
struct TrackedObject {
  DetectedObject detection;  ///< its id is the position in the frame's list, from 1
  TrackId track;
  std::optional<BoxOrigin> filled;  ///< set when the network has missed it
  MaskSource mask_source = MaskSource::kDetected;
};

/// The objects of a frame: those detected, in the order of the detections, then those filled in.
struct FrameObjects {
  FrameId frame;
  Stamp stamp;
  std::vector<TrackedObject> objects;  ///< at most 255
  ObjectMask mask;                     ///< ids as in `objects`; empty where no object has pixels
};

/// What object tracking sees of a frame.
struct ObservedFrame {
  FrameId id;
  FrameDetections detections;
  DepthImage depth;  ///< as large as the mask
};

}  // namespace stillmap
