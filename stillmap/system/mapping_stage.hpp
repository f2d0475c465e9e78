// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stillmap/concurrency/job_ledger.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/mapping/local_mapper.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// Enters key frames into the map and maps their surroundings, on a window of the map.
class MappingStage {
 public:
  MappingStage(const MappingConfig& config,
               const CameraModel& camera,
               const MeasurementModel& measure,
               const StageOptions& options);

  /// A stage with the same pending updates, whose own work runs inline.
  [[nodiscard]] MappingStage inline_copy() const;

  /// Enters a key frame that observes `landmarks` (one for each feature, invalid for none), makes
  /// new landmarks of its depth, and begins the mapping around it. `keyframe.landmarks` is empty.
  KeyframeId insert(Map& map,
                    Keyframe keyframe,
                    std::span<const LandmarkId> landmarks,
                    const CameraTimes& times,
                    std::int64_t frame_number);

  /// The results that are due, in the order of their key frames.
  [[nodiscard]] std::vector<MappingResult> collect_due(std::int64_t frame_number) {
    return jobs_.collect_due(frame_number);
  }
  /// Whether no window of the map is being worked on.
  [[nodiscard]] bool idle() const { return jobs_.empty(); }

 private:
  MappingConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  JobLedger<MappingResult> jobs_;
};

}  // namespace stillmap
