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

/// Keeps the place index of the key frames, detects and closes loops, and adjusts the submap after
/// each.
///
/// Calls that may move the map must be made while no window of it is in work.
class LoopStage {
 public:
  /// `measure` is the measurement model of loops (loop_measurement_model). Only the global
  /// adjustment may run on another thread. The same bits either way.
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
  /// Sets the place index of a loaded map.
  void set_places(PlaceIndex places) { places_ = std::move(places); }
  void tracking_lost() { detector_.clear(); }

  /// Looks for a loop that ends in the newest key frame and closes it: moves the map, merges the
  /// ends, and begins a global adjustment. To be called for each key frame. Returns whether a loop
  /// was closed, which is then the last of `loops`, the loops of the map.
  bool close(Map& map, std::vector<LoopEdge>& loops, KeyframeId newest, std::int64_t frame);

  /// Applies the adjustments that are due. Returns whether there was one.
  bool apply_due(Map& map, std::int64_t frame);

  /// Adjusts a submap a last time if this run has closed a loop. To be called at the end.
  void finish(Map& map, SubmapId submap);

 private:
  // number of the loop, and its correction
  using NumberedCorrection = std::pair<int, GlobalCorrection>;

  LoopConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  LoopDetector detector_;
  PlaceIndex places_;
  int closed_ = 0;
  JobLedger<NumberedCorrection> adjustments_;
};

}  // namespace stillmap
