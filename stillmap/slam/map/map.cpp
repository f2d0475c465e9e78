// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/map.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

auto find_observation(const Landmark& landmark, KeyframeId keyframe) {
  const auto at =
      std::ranges::lower_bound(landmark.observations, keyframe, {}, &Observation::keyframe);
  return at != landmark.observations.end() && at->keyframe == keyframe
             ? at
             : landmark.observations.end();
}

void insert_observation(Landmark& landmark, Observation observation) {
  const auto at = std::ranges::lower_bound(
      landmark.observations, observation.keyframe, {}, &Observation::keyframe);
  landmark.observations.insert(at, observation);
}

// The descriptor with the least median distance to the others. Never an outlier.
STILLMAP_POPCOUNT_CLONES
std::size_t most_central(std::span<const Descriptor> descriptors) {
  std::size_t best = 0;
  int best_median = std::numeric_limits<int>::max();
  std::vector<int> distances(descriptors.size());
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    std::size_t less = 0;  // number of distances below the best median
    for (std::size_t j = 0; j < descriptors.size(); ++j) {
      distances[j] = hamming_distance(descriptors[i], descriptors[j]);
      less += distances[j] < best_median ? 1 : 0;
    }
    const std::size_t middle = (distances.size() - 1) / 2;
    if (less <= middle)
      continue;  // the median is no less; computing it would take most of the time
    const auto median = distances.begin() + static_cast<std::ptrdiff_t>(middle);
    std::ranges::nth_element(distances, median);
    best_median = *median;
    best = i;
  }
  return best;
}

}  // namespace

Map Map::from_parts(MapParts parts, const std::string& place) {
  check_parts(parts, place);
  parts = linked(std::move(parts), place);
  Map map(std::move(parts.level_scales));
  for (Keyframe& keyframe : parts.keyframes) {
    const KeyframeId id = keyframe.id;
    map.keyframes_.emplace_hint(map.keyframes_.end(), id, std::move(keyframe));
  }
  map.landmarks_.reserve(parts.landmarks.size());
  for (Landmark& landmark : parts.landmarks) {
    const LandmarkId id = landmark.id;
    map.landmarks_.emplace(id, std::move(landmark));
  }
  map.dropped_keyframes_ = {parts.dropped_keyframes.begin(), parts.dropped_keyframes.end()};
  map.next_keyframe_ = parts.next_keyframe;
  map.next_landmark_ = parts.next_landmark;
  return map;
}

MapParts Map::parts() const {
  MapParts parts;
  parts.level_scales = level_scales_;
  parts.keyframes.reserve(keyframes_.size());
  for (const auto& [id, keyframe] : keyframes_) parts.keyframes.push_back(keyframe);
  parts.landmarks.reserve(landmarks_.size());
  for (const LandmarkId id : landmark_ids()) parts.landmarks.push_back(landmarks_.at(id));
  parts.dropped_keyframes = {dropped_keyframes_.begin(), dropped_keyframes_.end()};
  parts.next_keyframe = next_keyframe_;
  parts.next_landmark = next_landmark_;
  return parts;
}

const Landmark* Map::find(LandmarkId id) const {
  const auto at = landmarks_.find(id);
  return at == landmarks_.end() ? nullptr : &at->second;
}

std::vector<LandmarkId> Map::landmark_ids() const {
  std::vector<LandmarkId> ids;
  ids.reserve(landmarks_.size());
  for (const auto& [id, landmark] : landmarks_) ids.push_back(id);
  std::ranges::sort(ids);
  return ids;
}

LandmarkId Map::resolve(LandmarkId id) const {
  while (id.valid() && !landmarks_.contains(id)) {
    auto at = merged_into_.find(id);
    if (at == merged_into_.end()) {
      at = merged_earlier_.find(id);
      if (at == merged_earlier_.end()) return {};
    }
    id = at->second;
  }
  return id;
}

Anchor Map::anchor(KeyframeId id) const {
  Anchor anchor{id, Eigen::Isometry3d::Identity()};
  while (!keyframes_.contains(anchor.keyframe)) {
    const Anchor& next = dropped_keyframes_.at(anchor.keyframe);
    anchor = {next.keyframe, next.T_anchor_dropped * anchor.T_anchor_dropped};
  }
  return anchor;
}

Eigen::Isometry3d Map::T_world_keyframe(KeyframeId id) const {
  const Anchor fixed_to = anchor(id);
  return keyframes_.at(fixed_to.keyframe).T_world_camera * fixed_to.T_anchor_dropped;
}

Landmark& Map::touch(LandmarkId id) {
  changed_landmarks_.insert(id);
  return landmarks_.at(id);
}

Keyframe& Map::touch(KeyframeId id) {
  changed_keyframes_.insert(id);
  return keyframes_.at(id);
}

std::vector<SubmapId> Map::submaps() const {
  std::set<SubmapId> submaps;
  for (const auto& [id, keyframe] : keyframes_) submaps.insert(keyframe.submap);
  return {submaps.begin(), submaps.end()};
}

KeyframeId Map::add_keyframe(Keyframe keyframe) {
  const auto of_its_submap = [&](const auto& other) {
    return other.second.submap == keyframe.submap;
  };
  keyframe.is_origin = std::ranges::none_of(keyframes_, of_its_submap);
  const KeyframeId id = next_keyframe_;
  next_keyframe_ = KeyframeId(id.value + 1);
  keyframe.id = id;
  keyframe.landmarks.assign(keyframe.features->size(), LandmarkId{});
  keyframes_.emplace(id, std::move(keyframe));
  changed_keyframes_.insert(id);
  return id;
}

LandmarkId Map::add_landmark(const Eigen::Vector3d& p_world, Observation seen_by) {
  const LandmarkId id = next_landmark_;
  next_landmark_ = LandmarkId(id.value + 1);
  Landmark landmark;
  landmark.id = id;
  landmark.p_world = p_world;
  landmark.created_by = seen_by.keyframe;
  landmarks_.emplace(id, std::move(landmark));
  STILLMAP_CHECK(add_observation(id, seen_by));
  refresh(id);
  return id;
}

bool Map::add_observation(LandmarkId landmark, Observation observation) {
  const Landmark& current = landmarks_.at(landmark);
  if (find_observation(current, observation.keyframe) != current.observations.end()) return false;
  if (keyframes_.at(observation.keyframe).landmarks[observation.feature].valid()) return false;
  insert_observation(touch(landmark), observation);
  touch(observation.keyframe).landmarks[observation.feature] = landmark;
  return true;
}

void Map::remove_observation(LandmarkId landmark, KeyframeId keyframe) {
  Landmark& changed = touch(landmark);
  const auto at = find_observation(changed, keyframe);
  STILLMAP_CHECK(at != changed.observations.end());
  touch(keyframe).landmarks[at->feature] = LandmarkId{};
  changed.observations.erase(at);
  if (changed.observations.empty()) landmarks_.erase(landmark);
}

void Map::remove_landmark(LandmarkId id) {
  for (const Observation& observation : touch(id).observations) {
    touch(observation.keyframe).landmarks[observation.feature] = LandmarkId{};
  }
  landmarks_.erase(id);
}

void Map::merge_landmarks(LandmarkId gone, LandmarkId into) {
  STILLMAP_CHECK(gone != into);
  const Landmark source = landmarks_.at(gone);
  remove_landmark(gone);
  for (const Observation& observation : source.observations) add_observation(into, observation);
  Landmark& target = touch(into);
  target.times_expected += source.times_expected;
  target.times_found += source.times_found;
  merged_into_[gone] = into;
  new_merged_.emplace_back(gone, into);
  refresh(into);
}

void Map::remove_keyframe(KeyframeId id, KeyframeId anchor) {
  const Keyframe dropped = keyframes_.at(id);
  STILLMAP_CHECK(!dropped.is_origin);
  for (const LandmarkId landmark : dropped.landmarks) {
    if (landmark.valid()) remove_observation(landmark, id);
  }
  const Anchor fixed{anchor,
                     keyframes_.at(anchor).T_world_camera.inverse() * dropped.T_world_camera};
  keyframes_.erase(id);
  changed_keyframes_.erase(id);
  dropped_keyframes_[id] = fixed;
  new_dropped_.emplace_back(id, fixed);
}

void Map::join_submaps(SubmapId gone, SubmapId into, const Eigen::Isometry3d& T_into_gone) {
  STILLMAP_CHECK(gone != into);
  std::set<LandmarkId> moved;
  for (auto& [id, keyframe] : keyframes_) {
    if (keyframe.submap != gone) continue;
    touch(id);
    keyframe.submap = into;
    keyframe.is_origin = false;
    keyframe.T_world_camera = T_into_gone * keyframe.T_world_camera;
    for (const LandmarkId landmark : keyframe.landmarks) {
      if (landmark.valid()) moved.insert(landmark);
    }
  }
  for (const LandmarkId id : moved) {
    Landmark& landmark = touch(id);
    landmark.p_world = T_into_gone * landmark.p_world;
    landmark.viewing_direction = T_into_gone.linear() * landmark.viewing_direction;
  }
}

void Map::set_features(KeyframeId id, FeaturesPtr features, const FeatureTiming& timing) {
  Keyframe& keyframe = keyframes_.at(id);
  STILLMAP_CHECK(features->size() == keyframe.features->size());
  keyframe.features = std::move(features);
  keyframe.timing = timing;
  changed_keyframes_.insert(id);
}

void Map::set_pose(KeyframeId id, const Eigen::Isometry3d& T_world_camera) {
  touch(id).T_world_camera = T_world_camera;
}

void Map::set_position(LandmarkId id, const Eigen::Vector3d& p_world) {
  touch(id).p_world = p_world;
}

void Map::refresh(LandmarkId id) {
  Landmark& landmark = touch(id);
  std::vector<Descriptor> descriptors;
  descriptors.reserve(landmark.observations.size());
  landmark.viewing_direction.setZero();
  for (const Observation& observation : landmark.observations) {
    const Keyframe& keyframe = keyframes_.at(observation.keyframe);
    descriptors.push_back(keyframe.features->descriptors[observation.feature]);
    landmark.viewing_direction +=
        (landmark.p_world - keyframe.T_world_camera.translation()).normalized();
  }
  landmark.viewing_direction.normalize();
  landmark.descriptor = descriptors[most_central(descriptors)];

  // A corner on level l at distance d is on level 0 at d * scale(l).
  const Observation& first = landmark.observations.front();
  const Keyframe& keyframe = keyframes_.at(first.keyframe);
  const double distance = (landmark.p_world - keyframe.T_world_camera.translation()).norm();
  landmark.max_distance_m =
      distance * static_cast<double>(level_scales_[keyframe.features->level[first.feature]]);
  landmark.min_distance_m = landmark.max_distance_m / static_cast<double>(level_scales_.back());
}

Map Map::window(std::span<const KeyframeId> core) const {
  Map window(level_scales_);
  window.next_keyframe_ = next_keyframe_;
  window.next_landmark_ = next_landmark_;
  for (const KeyframeId id : core) window.keyframes_.emplace(id, keyframes_.at(id));
  for (const KeyframeId id : core) {
    for (const LandmarkId landmark : keyframes_.at(id).landmarks) {
      if (landmark.valid()) window.landmarks_.try_emplace(landmark, landmarks_.at(landmark));
    }
  }
  for (const auto& [id, landmark] : window.landmarks_) {
    for (const Observation& observation : landmark.observations) {
      if (window.keyframes_.contains(observation.keyframe)) continue;
      window.keyframes_.emplace(observation.keyframe, keyframes_.at(observation.keyframe));
    }
  }
  return window;
}

MapUpdate Map::take_changes() {
  MapUpdate update;
  for (const KeyframeId id : changed_keyframes_) update.keyframes.push_back(keyframes_.at(id));
  for (const LandmarkId id : changed_landmarks_) {
    if (const Landmark* landmark = find(id)) {
      update.landmarks.push_back(*landmark);
    } else {
      update.removed_landmarks.push_back(id);
    }
  }
  update.dropped_keyframes = std::move(new_dropped_);
  update.merged_landmarks = std::move(new_merged_);
  update.next_landmark = next_landmark_;
  changed_keyframes_.clear();
  changed_landmarks_.clear();
  new_dropped_.clear();
  new_merged_.clear();
  return update;
}

void Map::forget_old_merges() {
  if (++updates_ < kMergesKept) return;
  updates_ = 0;
  merged_earlier_ = std::move(merged_into_);
  merged_into_.clear();
}

void Map::apply(const MapUpdate& update) {
  forget_old_merges();
  for (const auto& [gone, into] : update.merged_landmarks) {
    merged_into_[gone] = into;
    // Creates the landmarks that the window created, so that both have counts; they are filled in
    // or removed below.
    Landmark& target = landmarks_[into];
    const Landmark& source = landmarks_[gone];
    target.times_expected += source.times_expected;
    target.times_found += source.times_found;
  }
  for (const LandmarkId id : update.removed_landmarks) landmarks_.erase(id);
  for (const Landmark& changed : update.landmarks) {
    const auto [at, is_new] = landmarks_.try_emplace(changed.id, changed);
    if (is_new) continue;
    const int expected = at->second.times_expected, found = at->second.times_found;
    at->second = changed;
    at->second.times_expected = expected;
    at->second.times_found = found;
  }
  for (const Keyframe& changed : update.keyframes) keyframes_.at(changed.id) = changed;
  for (const auto& [id, anchor] : update.dropped_keyframes) {
    keyframes_.erase(id);
    dropped_keyframes_[id] = anchor;
  }
  next_landmark_ = update.next_landmark;
}

void Map::check_consistency() const {
  for (const auto& [id, keyframe] : keyframes_) {
    STILLMAP_CHECK(keyframe.id == id);
    STILLMAP_CHECK(keyframe.landmarks.size() == keyframe.features->size());
    for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
      const Landmark* landmark = find(keyframe.landmarks[i]);
      if (landmark == nullptr) continue;  // no landmark, or outside this window
      const auto at = find_observation(*landmark, id);
      STILLMAP_CHECK(at != landmark->observations.end() && at->feature == i);
    }
  }
  for (const auto& [id, landmark] : landmarks_) {
    STILLMAP_CHECK(landmark.id == id && !landmark.observations.empty());
    STILLMAP_CHECK(landmark.p_world.allFinite());
    STILLMAP_CHECK(id < next_landmark_);
    for (std::size_t i = 0; i < landmark.observations.size(); ++i) {
      const Observation& observation = landmark.observations[i];
      STILLMAP_CHECK(keyframes_.at(observation.keyframe).landmarks[observation.feature] == id);
      STILLMAP_CHECK(i == 0 || landmark.observations[i - 1].keyframe < observation.keyframe);
    }
  }
}

}  // namespace stillmap
