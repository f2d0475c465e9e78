// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"
#include "stillmap/slam/optim/pose_optimizer.hpp"
#include "stillmap/slam/tracking/motion_model.hpp"
#include "stillmap/slam/tracking/relocalizer.hpp"
#include "stillmap/slam/tracking/rolling_shutter.hpp"
#include "stillmap/slam/tracking/tracked_frame.hpp"

namespace stillmap {

struct TrackerConfig {
  double frame_search_radius_px = 15;
  double map_search_radius_px = 8;
  int local_keyframes = 30;
  int min_frame_matches = 20;
  int min_frame_inliers = 10;
  int min_inliers = 30;
  MatchRules frame_match{.max_distance = 90};
  MatchRules reference_match{.max_distance = 60, .max_ratio = 0.7};
  MatchRules map_match{.max_distance = 90, .max_ratio = 0.8};
  ShutterConfig shutter;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("frame_search_radius_px",
          self.frame_search_radius_px,
          FieldInfo{"search for the last frame's points, on the finest level", "px", 1, 200});
    visit("map_search_radius_px",
          self.map_search_radius_px,
          FieldInfo{"search for the local map's points, on the finest level", "px", 1, 100});
    visit("local_keyframes",
          self.local_keyframes,
          FieldInfo{"key frames whose landmarks are searched in a frame", "", 1, 1000});
    visit("min_frame_matches",
          self.min_frame_matches,
          FieldInfo{"matches with the last frame, or else with the reference key frame, from which "
                    "a pose is sought",
                    "",
                    3,
                    1000});
    visit("min_frame_inliers",
          self.min_frame_inliers,
          FieldInfo{"of these matches that must agree with the pose", "", 3, 1000});
    visit.group("frame_match", self.frame_match);
    visit.group("reference_match", self.reference_match);
    visit.group("map_match", self.map_match);
    visit.group("shutter", self.shutter);
    visit("min_inliers",
          self.min_inliers,
          FieldInfo{"landmarks that must be found for a frame to be tracked", "", 6, 1000});
  }
};

/// The camera's pose, frame after frame, against a map that it only reads.
///
/// Each frame is first matched to the last one under constant velocity (with a wider search, and
/// then with the reference key frame by appearance, if that fails), then to the local map: the
/// landmarks of the key frames that share landmarks with it. When lost, it looks for a known place
/// in every frame. Poses are kept relative to key frames, so that changes of the map reach them.
class Tracker {
 public:
  Tracker(const TrackerConfig& config,
          const RelocalizerConfig& relocalizer,
          const CameraModel& camera,
          MeasurementModel measure,
          std::uint32_t seed);

  /// The frame that a world begins with: at its origin.
  [[nodiscard]] TrackedFrame start(const RgbdFrame& frame, FeaturesPtr features);

  /// Lost as long as no world was begun and no place of the map is recognised. `places` holds the
  /// map's key frames, to look for the camera among them.
  [[nodiscard]] TrackedFrame track(const RgbdFrame& frame,
                                   Features features,
                                   const Map& map,
                                   const PlaceIndex& places);

  /// Where the camera should be at a time soon after the last frame; nothing when it is lost or has
  /// not begun.
  [[nodiscard]] std::optional<Eigen::Isometry3d> expected_pose(double stamp_s,
                                                               const Map& map) const;

  /// The camera's rolling shutter, as learnt so far.
  [[nodiscard]] double readout_s() const { return readout_.readout_s(); }

  /// The last frame has become a key frame of the map.
  void set_reference(KeyframeId keyframe, const Map& map);

 private:
  struct Match {
    std::uint32_t feature;
    LandmarkId landmark;  // invalid for a point of the last frame that is no landmark
    Eigen::Vector3d p_world;
  };
  using Matches = std::vector<Match>;
  struct PoseFromMatches {
    Eigen::Isometry3d T_camera_world;
    Matches inliers;
  };

  [[nodiscard]] std::optional<PoseFromMatches> find_pose(const TrackedFrame& frame,
                                                         const Features& features,
                                                         const Map& map,
                                                         const PlaceIndex& places) const;
  [[nodiscard]] std::optional<PoseFromMatches> track_last_frame(const TrackedFrame& frame,
                                                                const Features& features,
                                                                const Map& map) const;
  [[nodiscard]] std::optional<PoseFromMatches> track_reference(const TrackedFrame& frame,
                                                               const Features& features,
                                                               const Map& map) const;
  [[nodiscard]] std::optional<PoseFromMatches> relocalize(const TrackedFrame& frame,
                                                          const Features& features,
                                                          const Map& map,
                                                          const PlaceIndex& places) const;
  [[nodiscard]] Matches match_last_frame(const Features& features,
                                         const Map& map,
                                         const Eigen::Isometry3d& T_camera_world,
                                         double radius_px) const;
  [[nodiscard]] PoseFromMatches track_local_map(TrackedFrame& frame,
                                                const Features& features,
                                                const PoseFromMatches& start,
                                                const Map& map) const;
  [[nodiscard]] PoseFromMatches refine_shutter(const TrackedFrame& frame,
                                               Features& features,
                                               const PoseFromMatches& pose,
                                               const Map& map);
  [[nodiscard]] std::vector<LandmarkId> local_landmarks(TrackedFrame& frame,
                                                        const Matches& matches,
                                                        const Map& map) const;
  [[nodiscard]] PoseFromMatches optimize(const Features& features,
                                         const Eigen::Isometry3d& initial,
                                         const Matches& matches) const;
  [[nodiscard]] Eigen::Isometry3d last_pose(const Map& map) const;
  void remember(const TrackedFrame& frame, const Map& map);

  TrackerConfig config_;
  Relocalizer relocalizer_;
  CameraModel camera_;
  MeasurementModel measure_;

  std::optional<TrackedFrame> last_;  // the last frame with a pose
  Eigen::Isometry3d T_reference_last_ = Eigen::Isometry3d::Identity();
  MotionModel motion_;
  ReadoutEstimator readout_;
  bool lost_ = true;
};

}  // namespace stillmap
