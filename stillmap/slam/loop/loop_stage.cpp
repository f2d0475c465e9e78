// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_stage.hpp"

#include "stillmap/slam/loop/loop_closer.hpp"

namespace stillmap {

LoopStage::LoopStage(const LoopConfig& config,
                     const CameraModel& camera,
                     const MeasurementModel& measure,
                     std::uint32_t seed,
                     const StageOptions& options)
    : config_(config),
      camera_(camera),
      measure_(measure),
      detector_(config, camera, measure, seed),
      adjustments_(options.worker,
                   [probe = options.probe] { begin_work(probe, Stage::kAdjustment); }) {}

LoopStage LoopStage::inline_copy() const {
  LoopStage copy = *this;
  copy.adjustments_ = adjustments_.inline_copy();
  return copy;
}

bool LoopStage::close(Map& map,
                      std::vector<LoopEdge>& loops,
                      KeyframeId newest,
                      std::int64_t frame) {
  if (!config_.enabled) return false;
  const std::optional<LoopMatch> found = detector_.advance(map, places_, newest);
  if (!found) return false;
  if (!close_loop(map, loops, *found, camera_, measure_, config_)) return false;
  detector_.clear();
  ++closed_;
  auto window = std::make_shared<Map>(submap_window(map, map.keyframe(newest).submap));
  adjustments_.submit(frame + config_.adjustment_lag_frames, [window, number = closed_, this] {
    return NumberedCorrection(
        number, adjust_globally(std::move(*window), camera_, measure_, config_.bundle));
  });
  return true;
}

bool LoopStage::apply_due(Map& map, std::int64_t frame) {
  bool moved = false;
  for (const auto& [number, correction] : adjustments_.collect_due(frame)) {
    if (number != closed_)
      continue;  // a later loop has moved the map and has an adjustment of its own
    apply_correction(map, correction);
    moved = true;
  }
  return moved;
}

void LoopStage::finish(Map& map, SubmapId submap) {
  if (closed_ == 0 || !submap.valid()) return;
  apply_correction(map,
                   adjust_globally(submap_window(map, submap), camera_, measure_, config_.bundle));
}

}  // namespace stillmap
