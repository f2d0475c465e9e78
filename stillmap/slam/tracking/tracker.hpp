// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
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
#include "stillmap/slam/tracking/tracked_frame.hpp"

namespace stillmap {

struct TrackerConfig {
  double frame_search_radius_px = 15;
  double map_search_radius_px = 8;
  int local_keyframes = 30;
  int min_frame_matches = 20;
  int min_frame_inliers = 10;
  int min_inliers = 30;
  int enough_inliers = 500;
  double confirmed_share = 0.6;
  MatchRules frame_match{.max_distance = 90};
  MatchRules reference_match{.max_distance = 60, .max_ratio = 0.7};
  MatchRules map_match{.max_distance = 90, .max_ratio = 0.8};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("frame_search_radius_px",
          self.frame_search_radius_px,
          FieldInfo{"search radius for the previous frame's landmarks, at the finest pyramid level",
                    "px",
                    1,
                    200});
    visit("map_search_radius_px",
          self.map_search_radius_px,
          FieldInfo{"search radius for the local map's landmarks, at the finest pyramid level",
                    "px",
                    1,
                    100});
    visit("local_keyframes",
          self.local_keyframes,
          FieldInfo{
              "number of key frames whose landmarks form the local map of a frame", "", 1, 1000});
    visit("min_frame_matches",
          self.min_frame_matches,
          FieldInfo{"number of matches with the previous frame, or with the reference key frame, "
                    "needed to estimate a pose",
                    "",
                    3,
                    1000});
    visit("min_frame_inliers",
          self.min_frame_inliers,
          FieldInfo{"number of these matches that must agree with the pose", "", 3, 1000});
    visit.group("frame_match", self.frame_match);
    visit.group("reference_match", self.reference_match);
    visit.group("map_match", self.map_match);
    visit("enough_inliers",
          self.enough_inliers,
          FieldInfo{
              "number of matched landmarks below which features on dynamic objects are used, too, "
              "weighted by their trust",
              "",
              0,
              10000});
    visit(
        "confirmed_share",
        self.confirmed_share,
        FieldInfo{"share of the matched landmarks elsewhere that must agree with a pose found with "
                  "such features",
                  "",
                  0,
                  1});
    visit("min_inliers",
          self.min_inliers,
          common_setting(FieldInfo{
              "number of landmarks that a frame must match to be tracked; with fewer it is lost",
              "",
              6,
              1000}));
  }
};

/// Returns the given features of a frame, followed by further ones that are less certain to be
/// static; nothing where there are none.
using MoreFeatures = std::function<std::optional<Features>(const Features&)>;

/// Tracks the camera's pose frame by frame against a map, which it only reads.
///
/// Each frame is first matched to the previous one under constant velocity; if that fails, with a
/// wider search, then with the reference key frame by appearance. Then it is matched to the local
/// map: the landmarks of the key frames that share landmarks with it. While lost, it tries to
/// relocalise in every frame. Where the features match too few landmarks, further features may be
/// requested; the landmarks matched without them, if enough for a pose, must then agree. Poses are
/// kept relative to key frames, so that they follow changes of the map.
class Tracker {
 public:
  Tracker(const TrackerConfig& config,
          const RelocalizerConfig& relocalizer,
          const CameraModel& camera,
          MeasurementModel measure,
          std::uint32_t seed);

  /// Begins a submap with a frame; the frame's camera is the origin of the submap.
  [[nodiscard]] TrackedFrame start(const RgbdFrame& frame, FeaturesPtr features);

  /// The status is kLost until a submap is begun or a place of the map is recognised. `places` has
  /// the key frames of the map, for relocalisation.
  [[nodiscard]] TrackedFrame track(const RgbdFrame& frame,
                                   Features features,
                                   const Map& map,
                                   const PlaceIndex& places,
                                   const MoreFeatures& more = {});

  /// The predicted pose at a time soon after the last frame; nothing while lost and before the
  /// first frame.
  [[nodiscard]] std::optional<Eigen::Isometry3d> expected_pose(double stamp_s,
                                                               const Map& map) const;

  /// Tells the tracker the times of the camera, for which it corrects features from now on.
  void assume(const CameraTimes& times) { times_ = times; }

  /// Tells the tracker that the last frame has become a key frame of the map.
  void set_reference(KeyframeId keyframe, const Map& map);

 private:
  struct Match {
    std::uint32_t feature;
    LandmarkId landmark;  // invalid for a point of the previous frame that is no landmark
    Eigen::Vector3d p_world;
  };
  using Matches = std::vector<Match>;
  struct PoseFromMatches {
    Eigen::Isometry3d T_camera_world;
    Matches inliers;
  };

  struct Attempt {
    TrackedFrame frame;
    Features features;
    std::optional<PoseFromMatches> pose;
    [[nodiscard]] int inliers() const { return pose ? static_cast<int>(pose->inliers.size()) : 0; }
    [[nodiscard]] double trust() const;  // in all inliers together
  };

  [[nodiscard]] Attempt attempt(const TrackedFrame& frame,
                                Features features,
                                const Map& map,
                                const PlaceIndex& places) const;
  [[nodiscard]] bool confirms(const Attempt& with_more, const Attempt& without) const;
  void locate(Attempt& attempt, const std::optional<PoseFromMatches>& start, const Map& map) const;
  [[nodiscard]] std::optional<PoseFromMatches> follow(const TrackedFrame& frame,
                                                      const Features& features,
                                                      const Map& map) const;
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
  [[nodiscard]] PoseFromMatches refine_times(TrackedFrame& frame,
                                             Features& features,
                                             const PoseFromMatches& pose,
                                             const Map& map) const;
  [[nodiscard]] std::vector<LandmarkId> local_landmarks(TrackedFrame& frame,
                                                        const Matches& matches,
                                                        const Map& map) const;
  [[nodiscard]] std::vector<PoseObservation> observations_of(const Features& features,
                                                             const Matches& matches) const;
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
  CameraTimes times_;
  bool lost_ = true;
};

}  // namespace stillmap
