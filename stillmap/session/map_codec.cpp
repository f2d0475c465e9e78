// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "stillmap/session/codec.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kObservationSize = 8;
// With one observation, the least number.
constexpr std::size_t kLeastLandmarkSize = 116 + kObservationSize;

void put(ByteWriter& out, const Landmark& landmark) {
  out.number(landmark.id.value);
  out.number(landmark.created_by.value);
  out.vector(landmark.p_world);
  out.vector(landmark.viewing_direction);
  out.number(landmark.min_distance_m);
  out.number(landmark.max_distance_m);
  out.number(static_cast<std::int32_t>(landmark.times_expected));
  out.number(static_cast<std::int32_t>(landmark.times_found));
  for (const std::uint64_t word : landmark.descriptor) out.number(word);
  out.count(landmark.observations.size());
  for (const Observation& observation : landmark.observations) {
    out.number(observation.keyframe.value);
    out.number(observation.feature);
  }
}

Landmark take_landmark(ByteReader& in) {
  Landmark landmark;
  landmark.id = take_id<LandmarkId>(in);
  landmark.created_by = take_id<KeyframeId>(in);
  landmark.p_world = in.vector();
  landmark.viewing_direction = in.vector();
  landmark.min_distance_m = in.number<double>();
  landmark.max_distance_m = in.number<double>();
  landmark.times_expected = in.number<std::int32_t>();
  landmark.times_found = in.number<std::int32_t>();
  for (std::uint64_t& word : landmark.descriptor) word = in.number<std::uint64_t>();
  landmark.observations.resize(in.count(kObservationSize));
  for (Observation& observation : landmark.observations) {
    observation.keyframe = take_id<KeyframeId>(in);
    observation.feature = in.number<std::uint32_t>();
  }
  return landmark;
}

void put(ByteWriter& out, const Features& features) {
  out.count(features.size());
  out.array<float>(features.raw_px);
  out.array<float>(features.ideal_px);
  out.array<float>(features.px);
  out.array<float>(features.sensor_depth_m);
  out.array<float>(features.depth_m);
  out.array<float>(features.angle_deg);
  out.array<std::uint8_t>(features.level);
  out.array<std::uint64_t>(features.descriptors);
}

Features take_features(ByteReader& in) {
  const std::size_t size = in.count(69);
  Features features;
  features.raw_px = in.array<float, Eigen::Vector2f>(size);
  features.ideal_px = in.array<float, Eigen::Vector2f>(size);
  features.px = in.array<float, Eigen::Vector2f>(size);
  features.sensor_depth_m = in.array<float, float>(size);
  features.depth_m = in.array<float, float>(size);
  features.angle_deg = in.array<float, float>(size);
  features.level = in.array<std::uint8_t, std::uint8_t>(size);
  features.descriptors = in.array<std::uint64_t, Descriptor>(size);
  return features;
}

}  // namespace

void put(ByteWriter& out, const Stamp& stamp) {
  out.number(stamp.seconds);
  out.text(stamp.text);
}

Stamp take_stamp(ByteReader& in) {
  const auto seconds = in.number<double>();
  return {seconds, in.text()};
}

ByteWriter encode_map_head(const MapParts& map) {
  ByteWriter out;
  out.number(map.next_keyframe.value);
  out.number(map.next_landmark.value);
  out.count(map.level_scales.size());
  out.array<float>(map.level_scales);
  return out;
}

MapParts decode_map_head(ByteReader content) {
  MapParts map;
  map.next_keyframe = take_id<KeyframeId>(content);
  map.next_landmark = take_id<LandmarkId>(content);
  map.level_scales = content.array<float, float>(content.count(sizeof(float)));
  content.finish();
  return map;
}

ByteWriter encode(const Keyframe& keyframe) {
  ByteWriter out;
  out.number(keyframe.id.value);
  out.number(keyframe.frame.value);
  out.number(keyframe.submap.value);
  out.flag(keyframe.is_origin);
  put(out, keyframe.stamp);
  out.pose(keyframe.T_world_camera);
  put(out, *keyframe.features);
  return out;
}

Keyframe decode_keyframe(ByteReader content, const CameraModel& camera) {
  Keyframe keyframe;
  keyframe.id = take_id<KeyframeId>(content);
  keyframe.frame = take_id<FrameId>(content);
  keyframe.submap = take_id<SubmapId>(content);
  keyframe.is_origin = content.flag();
  keyframe.stamp = take_stamp(content);
  keyframe.T_world_camera = content.pose();
  Features features = take_features(content);
  content.finish();
  features.grid = FeatureGrid(features.px, camera.width_px, camera.height_px);
  keyframe.features = std::make_shared<const Features>(std::move(features));
  return keyframe;
}

ByteWriter encode(std::span<const Landmark> landmarks) {
  ByteWriter out;
  out.count(landmarks.size());
  for (const Landmark& landmark : landmarks) put(out, landmark);
  return out;
}

std::vector<Landmark> decode_landmarks(ByteReader content) {
  std::vector<Landmark> landmarks(content.count(kLeastLandmarkSize));
  for (Landmark& landmark : landmarks) landmark = take_landmark(content);
  content.finish();
  return landmarks;
}

ByteWriter encode(const DroppedKeyframes& dropped) {
  ByteWriter out;
  out.count(dropped.size());
  for (const auto& [id, anchor] : dropped) {
    out.number(id.value);
    out.number(anchor.keyframe.value);
    out.pose(anchor.T_anchor_dropped);
  }
  return out;
}

DroppedKeyframes decode_dropped(ByteReader content) {
  DroppedKeyframes dropped(content.count(8 + kPoseSize));
  for (auto& [id, anchor] : dropped) {
    id = take_id<KeyframeId>(content);
    anchor.keyframe = take_id<KeyframeId>(content);
    anchor.T_anchor_dropped = content.pose();
  }
  content.finish();
  return dropped;
}

}  // namespace stillmap
