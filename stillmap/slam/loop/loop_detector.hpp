// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/slam/loop/loop_config.hpp"
#include "stillmap/slam/loop/loop_gate.hpp"
#include "stillmap/slam/loop/loop_verifier.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/map/place_index.hpp"

namespace stillmap {

/// Finds, key frame after key frame, the places that were seen before: candidates by appearance,
/// which several key frames in a row must find, decided by geometry. The earlier key frame may be
/// of another submap.
class LoopDetector {
 public:
  /// `measure`: see LoopVerifier.
  LoopDetector(const LoopConfig& config,
               const CameraModel& camera,
               MeasurementModel measure,
               std::uint32_t seed);

  /// To be called for every key frame, in their order, once its landmarks are mapped. `places`
  /// holds all key frames of the map, also the newest. The match's `a` is the earlier key frame.
  [[nodiscard]] std::optional<LoopMatch> advance(const Map& map,
                                                 const PlaceIndex& places,
                                                 KeyframeId newest);

  /// After a loop was closed, or tracking was lost.
  void clear() { gate_.clear(); }

 private:
  LoopConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  LoopGate gate_;
  LoopVerifier verifier_;
};

}  // namespace stillmap
