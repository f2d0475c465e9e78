// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>

#include "stillmap/perception/objects/frame_objects.hpp"

namespace stillmap {

/// The tracks by which objects are known at the end of a run.
class LastingTracks {
 public:
  /// `united` is in the order of finding, as in RunResult.
  explicit LastingTracks(std::span<const UnitedTracks> united) {
    for (const UnitedTracks& pair : united) {
      for (auto& [track, known_as] : known_as_) {
        if (known_as == pair.later) known_as = pair.earlier;
      }
      known_as_[pair.later] = pair.earlier;
    }
  }

  /// The lasting track of an object that had `track` in a frame.
  [[nodiscard]] TrackId of(TrackId track) const {
    const auto found = known_as_.find(track);
    return found == known_as_.end() ? track : found->second;
  }

 private:
  std::map<TrackId, TrackId> known_as_;
};

}  // namespace stillmap
