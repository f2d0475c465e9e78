// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/mapping_stage.hpp"

#include <memory>
#include <utility>

namespace stillmap {

MappingStage::MappingStage(const MappingConfig& config,
                           const CameraModel& camera,
                           const MeasurementModel& measure,
                           const StageOptions& options)
    : config_(config),
      camera_(camera),
      measure_(measure),
      jobs_(options.worker, [probe = options.probe] { begin_work(probe, Stage::kMapping); }) {}

MappingStage MappingStage::inline_copy() const {
  MappingStage copy = *this;
  copy.jobs_ = jobs_.inline_copy();
  return copy;
}

KeyframeId MappingStage::insert(Map& map,
                                Keyframe keyframe,
                                std::span<const LandmarkId> landmarks,
                                const CameraTimes& times,
                                std::int64_t frame_number) {
  const KeyframeId id = map.add_keyframe(std::move(keyframe));
  for (std::uint32_t i = 0; i < landmarks.size(); ++i) {
    if (!landmarks[i].valid()) continue;
    map.add_observation(landmarks[i], {id, i});
    map.refresh(landmarks[i]);
  }
  create_landmarks_from_depth(map, id, camera_, measure_, config_.creation);
  (void)map.take_changes();  // the owner knows them; only changes of windows are passed on

  std::vector<KeyframeId> core = mapping_core(map, id, config_);
  auto window = std::make_shared<Map>(map.window(core));
  jobs_.submit(frame_number + config_.lag_frames, [window, core = std::move(core), times, this] {
    return map_locally(std::move(*window), core, camera_, times, measure_, config_);
  });
  return id;
}

}  // namespace stillmap
