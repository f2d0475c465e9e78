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

/// The number of a track. An ObjectTracker's tracks follow an object from frame to frame and end
/// when it is not seen for some; those of ObjectIdentities last.
using TrackId = Id<struct TrackTag>;

/// Two tracks that turned out to be of one object: frames until then have them both.
struct UnitedTracks {
  TrackId later;    ///< no frame after that has it
  TrackId earlier;  ///< the object's track from then on
};

/// The source of an object's pixels.
enum class MaskSource : std::uint8_t {
  kDetected,  ///< the network, in this frame; possibly without pixels
  kDepth,     ///< the depth in its box, in this frame: the network gave the box alone
  kCarried,   ///< the mask of the nearest frame with the object, refined by depth
  kBox,       ///< the whole box of the object
};

/// The frames from which a filled box comes.
struct BoxOrigin {
  std::optional<FrameId> before;  ///< the nearest earlier frame in which it was detected
  std::optional<FrameId> after;   ///< the nearest later one

  /// Exact equality of both.
  bool operator==(const BoxOrigin&) const = default;
};

/// An object of a frame with its track.
struct TrackedObject {
  DetectedObject detection;         ///< its id is its position in the list of the frame, from 1
  TrackId track;                    ///< the same in all frames of the object
  std::optional<BoxOrigin> filled;  ///< set if the network missed the object
  MaskSource mask_source = MaskSource::kDetected;  ///< where its pixels come from
};

/// The objects of a frame: the detected ones, in the order of the detections, then the filled ones.
struct FrameObjects {
  FrameId frame;                       ///< of the frame in which they are
  Stamp stamp;                         ///< of that frame
  std::vector<TrackedObject> objects;  ///< at most 255
  ObjectMask mask;                     ///< ids as in `objects`; empty where no object has pixels
};

}  // namespace stillmap
