// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/slam/loop/loop_config.hpp"
#include "stillmap/slam/loop/loop_gate.hpp"
#include "stillmap/slam/loop/loop_verifier.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/map/place_index.hpp"

namespace stillmap {

/// Detects loops, key frame by key frame: candidates by appearance, which several consecutive key
/// frames must find, are verified by geometry. The earlier key frame may be in another submap.
class LoopDetector {
 public:
  /// `measure`: see LoopVerifier.
  LoopDetector(const LoopConfig& config,
               const CameraModel& camera,
               MeasurementModel measure,
               std::uint32_t seed);

  /// To be called for every key frame, in order, once its map update is applied. `places` must have
  /// all key frames of the map, including the newest. `a` of the result is the earlier key frame.
  [[nodiscard]] std::optional<LoopMatch> advance(const Map& map,
                                                 const PlaceIndex& places,
                                                 KeyframeId newest);

  /// Starts again. To be called after a loop was closed, and when tracking was lost.
  void clear() { gate_.clear(); }

 private:
  LoopConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  LoopGate gate_;
  LoopVerifier verifier_;
};

}  // namespace stillmap
