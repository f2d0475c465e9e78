// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/late_objects.hpp"

#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "stillmap/slam/features/feature_selection.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMostAwaiting = 30;  // frames; their images are held

}  // namespace

void LateObjects::await(Awaiting awaiting) {
  awaiting_.push_back(std::move(awaiting));
  if (awaiting_.size() > kMostAwaiting) awaiting_.pop_front();
}

std::optional<LateObjects::Awaiting> LateObjects::take(FrameId frame) {
  while (!awaiting_.empty() && awaiting_.front().frame->id < frame) awaiting_.pop_front();
  if (awaiting_.empty() || awaiting_.front().frame->id != frame) return std::nullopt;
  Awaiting found = std::move(awaiting_.front());
  awaiting_.pop_front();
  return found;
}

TrackedFrame without_excluded_features(const TrackedFrame& tracked,
                                       const Mask& excluded,
                                       const Map& map,
                                       const CameraModel& camera) {
  TrackedFrame result = tracked;
  const Features& features = *tracked.features;
  std::vector<std::uint8_t> keep(features.size(), 1);
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const Eigen::Vector2i px = features.raw_px[i].array().round().cast<int>();
    keep[i] = excluded.covers(px.y(), px.x()) ? 0 : 1;
  }
  std::vector<LandmarkId> landmarks;
  std::set<LandmarkId> seen;  // two landmarks may have been merged since
  result.inliers = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] == 0) continue;
    const LandmarkId id = map.resolve(tracked.landmarks[i]);
    const bool is_first = id.valid() && seen.insert(id).second;
    landmarks.push_back(is_first ? id : LandmarkId{});
    result.inliers += is_first ? 1 : 0;
  }
  result.landmarks = std::move(landmarks);
  result.features = std::make_shared<const Features>(select_features(features, keep, camera));
  return result;
}

}  // namespace stillmap
