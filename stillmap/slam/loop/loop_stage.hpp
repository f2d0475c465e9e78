// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "stillmap/concurrency/job_ledger.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/concurrency/worker.hpp"
#include "stillmap/slam/loop/global_adjustment.hpp"
#include "stillmap/slam/loop/loop_detector.hpp"

namespace stillmap {

/// Knows which places the key frames show, closes loops, and adjusts the whole submap after each.
///
/// All calls that may move the map are made while no window of it is being worked on.
class LoopStage {
 public:
  /// `measure` trusts depth as far as the sensor earns it. Only the adjustment of the submap may
  /// run on a thread of its own. The same bits either way.
  LoopStage(const LoopConfig& config,
            const CameraModel& camera,
            const MeasurementModel& measure,
            std::uint32_t seed,
            const StageOptions& options);

  /// A stage with the same pending adjustments, whose own work runs inline.
  [[nodiscard]] LoopStage inline_copy() const;

  [[nodiscard]] const PlaceIndex& places() const { return places_; }
  void add_keyframe(const Keyframe& keyframe) {
    places_.add(keyframe.id, keyframe.features->descriptors);
  }
  void remove_keyframe(KeyframeId id) { places_.remove(id); }
  /// The place index of a map that is there from the beginning.
  void set_places(PlaceIndex places) { places_ = std::move(places); }
  void tracking_lost() { detector_.clear(); }

  /// Looks for a loop that ends in the newest key frame, to be called for each, and closes it: the
  /// map is moved, its ends are merged, and an adjustment of the submap begins. Says whether it
  /// closed one, which is then the last of `loops`, all those of this map.
  bool close(Map& map, std::vector<LoopEdge>& loops, KeyframeId newest, std::int64_t frame);

  /// Brings adjustments that are due into the map. Says whether there was one.
  bool apply_due(Map& map, std::int64_t frame);

  /// At the end: adjusts a submap once more if this run has closed a loop, with all that has been
  /// seen since.
  void finish(Map& map, SubmapId submap);

 private:
  using NumberedCorrection = std::pair<int, GlobalCorrection>;  // of the n-th loop

  LoopConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  LoopDetector detector_;
  PlaceIndex places_;
  int closed_ = 0;
  JobLedger<NumberedCorrection> adjustments_;
};

}  // namespace stillmap
