// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/system_config.hpp"

#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {

void SystemConfig::check() const {
  if (keyframe.min_gap_frames < mapping.lag_frames) {
    throw Error(
        "keyframe.min_gap_frames is {}: expected at least mapping.lag_frames ({}), so that "
        "one key frame's mapping ends before the next begins",
        keyframe.min_gap_frames,
        mapping.lag_frames);
  }
  if (keyframe.max_gap_frames < keyframe.min_gap_frames) {
    throw Error("keyframe.max_gap_frames is {}: expected at least keyframe.min_gap_frames ({})",
                keyframe.max_gap_frames,
                keyframe.min_gap_frames);
  }
  if (tracking.orb.weak_corner_threshold > tracking.orb.corner_threshold) {
    throw Error(
        "tracking.weak_corner_threshold is {}: expected at most tracking.corner_threshold ({})",
        tracking.orb.weak_corner_threshold,
        tracking.orb.corner_threshold);
  }
}

MeasurementModel loop_measurement_model(const SystemConfig& config,
                                        std::vector<float> level_scales) {
  MeasurementConfig measurement = config.measurement;
  measurement.inverse_depth_sigma = config.loop.inverse_depth_sigma;
  return {measurement, std::move(level_scales)};
}

}  // namespace stillmap
