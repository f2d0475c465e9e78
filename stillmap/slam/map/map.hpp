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

/// The only owner of key frames and landmarks, which have ids.
///
/// All other code holds ids. Both directions of an observation (key frame -> landmark, landmark ->
/// key frame) change together. Covisibility is derived, not stored (covisibility.hpp).
///
/// A worker gets a window(), a separate map cut out of this one, and works on it with the same
/// operations. It returns its changes as a MapUpdate, which the owner applies at a frame fixed
/// beforehand. Until then the owner changes nothing but the counts of tracking.
class Map {
 public:
  /// Number of applied updates over which resolve() surely knows a merge.
  static constexpr int kMergesKept = 64;

  /// `level_scales` are the pixel sizes of the pyramid levels of the extractor.
  explicit Map(std::vector<float> level_scales) : level_scales_(std::move(level_scales)) {}

  /// Makes a map of parts; the key frames' lists of landmarks are rebuilt. Parts need not be
  /// trusted: throws Error, in one line that begins with `place`, for parts that form no map.
  [[nodiscard]] static Map from_parts(MapParts parts, const std::string& place);
  /// The parts of the map, as copies. Not for windows.
  [[nodiscard]] MapParts parts() const;

  [[nodiscard]] const std::map<KeyframeId, Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] const Keyframe& keyframe(KeyframeId id) const { return keyframes_.at(id); }
  [[nodiscard]] bool has(KeyframeId id) const { return keyframes_.contains(id); }
  /// The submaps with key frames, sorted.
  [[nodiscard]] std::vector<SubmapId> submaps() const;
  [[nodiscard]] std::size_t landmark_count() const { return landmarks_.size(); }
  [[nodiscard]] const Landmark& landmark(LandmarkId id) const { return landmarks_.at(id); }
  /// The landmark of an id; null if there is none, or no longer.
  [[nodiscard]] const Landmark* find(LandmarkId id) const;
  [[nodiscard]] std::vector<LandmarkId> landmark_ids() const;  ///< sorted
  [[nodiscard]] const std::vector<float>& level_scales() const { return level_scales_; }
  /// The landmark into which `id` was merged, over any number of merges; invalid if that was
  /// removed, or if a merge is older than the last kMergesKept updates that were applied: a map
  /// whose places are seen again and again merges landmarks without end.
  [[nodiscard]] LandmarkId resolve(LandmarkId id) const;
  /// The pose of a key frame, present or dropped. The id must have been in the map.
  [[nodiscard]] Eigen::Isometry3d T_world_keyframe(KeyframeId id) const;
  /// The key frame itself, or the anchor of a dropped key frame.
  [[nodiscard]] Anchor anchor(KeyframeId id) const;

  /// Adds a key frame, sets its id and origin flag, and empties its list of landmarks.
  KeyframeId add_keyframe(Keyframe keyframe);
  /// Adds a landmark with its first observation, `seen_by`.
  LandmarkId add_landmark(const Eigen::Vector3d& p_world, Observation seen_by);
  /// Adds an observation. Does nothing and returns false if the key frame already observes the
  /// landmark or the feature observes another.
  bool add_observation(LandmarkId landmark, Observation observation);
  /// Removes an observation, and the landmark with its last observation.
  void remove_observation(LandmarkId landmark, KeyframeId keyframe);
  void remove_landmark(LandmarkId id);
  /// Merges landmark `gone` into `into`. If a key frame observes both, the observation of `into`
  /// stays.
  void merge_landmarks(LandmarkId gone, LandmarkId into);
  /// Drops a key frame that is no origin. Frames that refer to it are fixed to `anchor`.
  void remove_keyframe(KeyframeId id, KeyframeId anchor);
  /// Replaces the features of a key frame by the same ones at corrected places.
  void set_features(KeyframeId id, FeaturesPtr features, const FeatureTiming& timing);
  void set_pose(KeyframeId id, const Eigen::Isometry3d& T_world_camera);
  void set_position(LandmarkId id, const Eigen::Vector3d& p_world);
  /// Moves everything in submap `gone` into another submap, which keeps its one origin. Not for
  /// windows.
  void join_submaps(SubmapId gone, SubmapId into, const Eigen::Isometry3d& T_into_gone);
  /// Updates descriptor, viewing direction and distance range from the observations.
  void refresh(LandmarkId id);
  void count_expected(LandmarkId id) { ++landmarks_.at(id).times_expected; }
  void count_found(LandmarkId id) { ++landmarks_.at(id).times_found; }

  /// A separate map of the key frames `core`, their landmarks, and all other key frames that
  /// observe one of these landmarks. The others may refer to landmarks outside the window (find()
  /// returns null). Key frames of `core` may be changed in every way; the others must not be
  /// dropped.
  [[nodiscard]] Map window(std::span<const KeyframeId> core) const;
  /// The changes since this map was made or changes were last taken.
  [[nodiscard]] MapUpdate take_changes();
  void apply(const MapUpdate& update);

  /// Throws InternalError for a violated invariant. For tests.
  void check_consistency() const;

 private:
  Landmark& touch(LandmarkId id);
  Keyframe& touch(KeyframeId id);
  void forget_old_merges();

  std::vector<float> level_scales_;
  std::map<KeyframeId, Keyframe> keyframes_;
  std::unordered_map<LandmarkId, Landmark> landmarks_;
  std::map<KeyframeId, Anchor> dropped_keyframes_;
  // Merges since the last multiple of kMergesKept updates, and those in as many updates before it.
  std::unordered_map<LandmarkId, LandmarkId> merged_into_, merged_earlier_;
  int updates_ = 0;
  KeyframeId next_keyframe_{0};
  LandmarkId next_landmark_{0};

  // Changes since the last take_changes().
  std::set<KeyframeId> changed_keyframes_;
  std::set<LandmarkId> changed_landmarks_;
  std::vector<std::pair<KeyframeId, Anchor>> new_dropped_;
  std::vector<std::pair<LandmarkId, LandmarkId>> new_merged_;
};

}  // namespace stillmap
