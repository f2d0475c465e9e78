// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/map/map.hpp"

namespace stillmap {

inline constexpr std::uint32_t kFeaturesPerKeyframe = 12;

/// Level scales of the random maps.
[[nodiscard]] inline std::vector<float> test_scales() {
  return {1.0F, 1.25F, 1.5F, 2.0F};
}

[[nodiscard]] inline std::uint32_t pick(std::mt19937& rng, std::size_t count) {
  return rng() % static_cast<std::uint32_t>(count);
}

[[nodiscard]] inline double coordinate(std::mt19937& rng) {
  return static_cast<double>(rng()) / 1e9 - 2.0;
}

[[nodiscard]] inline Eigen::Vector3d random_point(std::mt19937& rng) {
  const double x = coordinate(rng), y = coordinate(rng), z = coordinate(rng);
  return {x, y, z};
}

[[nodiscard]] inline Eigen::Isometry3d random_pose(std::mt19937& rng) {
  const Eigen::Vector3d turn = random_point(rng);
  return make_pose(so3_exp(turn), random_point(rng));
}

[[nodiscard]] inline Keyframe random_keyframe(std::mt19937& rng) {
  Features features;
  for (std::uint32_t i = 0; i < kFeaturesPerKeyframe; ++i) {
    features.px.push_back({static_cast<float>(i), 1.0F});
    features.level.push_back(static_cast<std::uint8_t>(pick(rng, test_scales().size())));
    Descriptor descriptor{};
    for (std::uint64_t& word : descriptor) word = rng();
    features.descriptors.push_back(descriptor);
  }
  Keyframe keyframe;
  keyframe.T_world_camera = random_pose(rng);
  keyframe.features = std::make_shared<const Features>(std::move(features));
  return keyframe;
}

/// One operation, applicable to any map that holds the ids that it names.
using MapOperation = std::function<void(Map&)>;

/// A random operation that is allowed on `map`: only key frames of `droppable` are dropped.
[[nodiscard]] inline MapOperation random_operation(const Map& map,
                                                   const std::vector<KeyframeId>& droppable,
                                                   std::mt19937& rng) {
  std::vector<KeyframeId> keyframes;
  for (const auto& [id, keyframe] : map.keyframes()) keyframes.push_back(id);
  const std::vector<LandmarkId> landmarks = map.landmark_ids();
  const KeyframeId keyframe = keyframes[pick(rng, keyframes.size())];
  const std::uint32_t feature = pick(rng, kFeaturesPerKeyframe);
  const Eigen::Vector3d p = random_point(rng);
  const std::uint32_t kind = pick(rng, 40);
  if (landmarks.empty() || kind < 16) {
    if (map.keyframe(keyframe).landmarks[feature].valid()) return [](Map&) {};
    return [=](Map& m) { m.add_landmark(p, {keyframe, feature}); };
  }
  const LandmarkId landmark = landmarks[pick(rng, landmarks.size())];
  const LandmarkId other = landmarks[pick(rng, landmarks.size())];
  if (kind < 30) return [=](Map& m) { m.add_observation(landmark, {keyframe, feature}); };
  if (kind < 32 && landmark != other) return [=](Map& m) { m.merge_landmarks(landmark, other); };
  if (kind == 32) return [=](Map& m) { m.remove_landmark(landmark); };
  if (kind < 35) {
    const std::vector<Observation>& seen = map.landmark(landmark).observations;
    const KeyframeId by = seen[pick(rng, seen.size())].keyframe;
    return [=](Map& m) { m.remove_observation(landmark, by); };
  }
  if (kind == 35) return [=](Map& m) { m.set_position(landmark, p); };
  if (kind == 36) {
    const Eigen::Isometry3d T = random_pose(rng);
    return [=](Map& m) { m.set_pose(keyframe, T); };
  }
  if (kind == 37 && !droppable.empty() && pick(rng, 2) == 0) {
    const KeyframeId gone = droppable[pick(rng, droppable.size())];
    if (!map.has(gone) || gone == keyframe || gone == keyframes.front()) return [](Map&) {};
    return [=](Map& m) { m.remove_keyframe(gone, keyframe); };
  }
  return [=](Map& m) { m.refresh(landmark); };
}

/// A map of `keyframes` random key frames after `operations` random operations that drop none.
[[nodiscard]] inline Map random_map(int keyframes, int operations, std::mt19937& rng) {
  Map map(test_scales());
  for (int i = 0; i < keyframes; ++i) map.add_keyframe(random_keyframe(rng));
  for (int i = 0; i < operations; ++i) random_operation(map, {}, rng)(map);
  return map;
}

}  // namespace stillmap
