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

template <class Value>
void append(std::vector<Value>& values, const std::vector<Value>& more) {
  values.insert(values.end(), more.begin(), more.end());
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
  if (!features.trust.empty()) result.trust = selected(features.trust, keep);
  result.grid = FeatureGrid(result.px, camera.width_px, camera.height_px);
  return result;
}

Features joined_features(const Features& a, const Features& b, const CameraModel& camera) {
  Features result = a;
  append(result.raw_px, b.raw_px);
  append(result.ideal_px, b.ideal_px);
  append(result.sensor_depth_m, b.sensor_depth_m);
  append(result.px, b.px);
  append(result.depth_m, b.depth_m);
  append(result.level, b.level);
  append(result.angle_deg, b.angle_deg);
  append(result.descriptors, b.descriptors);
  if (!a.trust.empty() || !b.trust.empty()) {
    result.trust.resize(a.size(), 1.0F);
    append(result.trust, b.trust);
    result.trust.resize(result.size(), 1.0F);
  }
  result.grid = FeatureGrid(result.px, camera.width_px, camera.height_px);
  return result;
}

}  // namespace stillmap
