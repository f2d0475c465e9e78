// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include "stillmap/slam/map/keyframe.hpp"
#include "stillmap/slam/map/landmark.hpp"
#include "stillmap/slam/map/map_parts.hpp"
#include "stillmap/slam/map/map_update.hpp"

namespace stillmap {

/// Key frames and landmarks, by id: their one owner.
///
/// Everyone else holds ids and asks. Both directions of an observation (key frame -> landmark,
/// landmark -> key frame) change together. Covisibility is not stored but derived
/// (covisibility.hpp).
///
/// A worker gets a window(): a map of its own, cut out of this one, on which it works with the same
/// operations. What it changed comes back as a MapUpdate, which the owner applies at a frame that
/// was fixed beforehand. Meanwhile the owner changes nothing but tracking's counts.
class Map {
 public:
  /// `level_scales`: size of a pixel of each pyramid level, as the extractor has them.
  explicit Map(std::vector<float> level_scales) : level_scales_(std::move(level_scales)) {}

  /// The map of these parts, whose key frames' lists of landmarks are made anew. They may come from
  /// anywhere: throws Error, in one line that starts with `place`, for parts of no map.
  [[nodiscard]] static Map from_parts(MapParts parts, const std::string& place);
  /// A copy of what it consists of. Not for windows.
  [[nodiscard]] MapParts parts() const;

  [[nodiscard]] const std::map<KeyframeId, Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] const Keyframe& keyframe(KeyframeId id) const { return keyframes_.at(id); }
  [[nodiscard]] bool has(KeyframeId id) const { return keyframes_.contains(id); }
  /// The submaps that have key frames, sorted.
  [[nodiscard]] std::vector<SubmapId> submaps() const;
  [[nodiscard]] std::size_t landmark_count() const { return landmarks_.size(); }
  [[nodiscard]] const Landmark& landmark(LandmarkId id) const { return landmarks_.at(id); }
  /// Null when there is none (any more).
  [[nodiscard]] const Landmark* find(LandmarkId id) const;
  [[nodiscard]] std::vector<LandmarkId> landmark_ids() const;  ///< sorted
  [[nodiscard]] const std::vector<float>& level_scales() const { return level_scales_; }
  /// The landmark that `id` was merged into, over any number of merges; invalid if that is gone.
  [[nodiscard]] LandmarkId resolve(LandmarkId id) const;
  /// Pose of a key frame, dropped ones included. The id was once in the map.
  [[nodiscard]] Eigen::Isometry3d T_world_keyframe(KeyframeId id) const;
  /// The key frame itself, or the one that a dropped one is fixed to.
  [[nodiscard]] Anchor anchor(KeyframeId id) const;

  /// Sets its id and whether it is an origin; its landmark list becomes empty.
  KeyframeId add_keyframe(Keyframe keyframe);
  /// A new landmark seen by feature `feature` of `keyframe`.
  LandmarkId add_landmark(const Eigen::Vector3d& p_world, Observation seen_by);
  /// False, with nothing done, if the key frame sees the landmark already or the feature is taken.
  bool add_observation(LandmarkId landmark, Observation observation);
  /// The landmark goes too when it was the last one.
  void remove_observation(LandmarkId landmark, KeyframeId keyframe);
  void remove_landmark(LandmarkId id);
  /// `gone` becomes part of `into`; where a key frame sees both, `into`'s feature stays.
  void merge_landmarks(LandmarkId gone, LandmarkId into);
  /// Drops a key frame that is no origin; frames that refer to it are fixed to `anchor`.
  void remove_keyframe(KeyframeId id, KeyframeId anchor);
  void set_pose(KeyframeId id, const Eigen::Isometry3d& T_world_camera);
  void set_position(LandmarkId id, const Eigen::Vector3d& p_world);
  /// Moves all that is in the submap `gone` into another, which then has one origin as before. Not
  /// for windows.
  void join_submaps(SubmapId gone, SubmapId into, const Eigen::Isometry3d& T_into_gone);
  /// Brings descriptor, viewing direction and distance range up to the observations.
  void refresh(LandmarkId id);
  void count_expected(LandmarkId id) { ++landmarks_.at(id).times_expected; }
  void count_found(LandmarkId id) { ++landmarks_.at(id).times_found; }

  /// A map of its own of `core`, the landmarks these see, and all other key frames that see one of
  /// those; the latter may refer to landmarks that are not in the window (find() gives null).
  /// `core` key frames may be changed in every way, the others not dropped.
  [[nodiscard]] Map window(std::span<const KeyframeId> core) const;
  /// What changed since this map was made or changes were last taken.
  [[nodiscard]] MapUpdate take_changes();
  void apply(const MapUpdate& update);

  /// Throws InternalError when an invariant does not hold. For tests.
  void check_consistency() const;

 private:
  Landmark& touch(LandmarkId id);
  Keyframe& touch(KeyframeId id);

  std::vector<float> level_scales_;
  std::map<KeyframeId, Keyframe> keyframes_;
  std::unordered_map<LandmarkId, Landmark> landmarks_;
  std::map<KeyframeId, Anchor> dropped_keyframes_;
  std::unordered_map<LandmarkId, LandmarkId> merged_into_;
  KeyframeId next_keyframe_{0};
  LandmarkId next_landmark_{0};

  // Changes since the last take_changes().
  std::set<KeyframeId> changed_keyframes_;
  std::set<LandmarkId> changed_landmarks_;
  std::vector<std::pair<KeyframeId, Anchor>> new_dropped_;
  std::vector<std::pair<LandmarkId, LandmarkId>> new_merged_;
};

}  // namespace stillmap
