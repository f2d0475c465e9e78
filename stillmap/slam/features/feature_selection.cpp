// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/feature_selection.hpp"

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

template <class Value>
std::vector<Value> selected(const std::vector<Value>& values, std::span<const std::uint8_t> keep) {
  std::vector<Value> result;
  result.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keep[i] != 0) result.push_back(values[i]);
  }
  return result;
}

}  // namespace

Features select_features(const Features& features,
                         std::span<const std::uint8_t> keep,
                         const CameraModel& camera) {
  STILLMAP_CHECK(keep.size() == features.size());
  Features result;
  result.raw_px = selected(features.raw_px, keep);
  result.ideal_px = selected(features.ideal_px, keep);
  result.sensor_depth_m = selected(features.sensor_depth_m, keep);
  result.px = selected(features.px, keep);
  result.depth_m = selected(features.depth_m, keep);
  result.level = selected(features.level, keep);
  result.angle_deg = selected(features.angle_deg, keep);
  result.descriptors = selected(features.descriptors, keep);
  result.grid = FeatureGrid(result.px, camera.width_px, camera.height_px);
  return result;
}

}  // namespace stillmap
