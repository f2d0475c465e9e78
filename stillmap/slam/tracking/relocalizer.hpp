// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/map/place_index.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"
#include "stillmap/slam/optim/pose_optimizer.hpp"

namespace stillmap {

struct RelocalizerConfig {
  int candidates = 5;
  int iterations = 300;
  int min_matches = 15;
  double search_radius_px = 15;
  int local_keyframes = 10;
  int min_inliers = 50;
  double min_share = 0.5;
  int new_world_after_frames = 60;
  MatchRules appearance_match{.max_distance = 60, .max_ratio = 0.8};
  MatchRules search_match{.max_distance = 64, .max_ratio = 0.9};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("candidates",
          self.candidates,
          FieldInfo{"number of key frames tried per frame while lost", "", 1, 1000});
    visit("iterations",
          self.iterations,
          FieldInfo{"greatest number of RANSAC iterations per key frame", "", 1, 100000});
    visit("min_matches",
          self.min_matches,
          FieldInfo{"number of matches by appearance that must agree on one pose", "", 4, 1000});
    visit(
        "search_radius_px",
        self.search_radius_px,
        FieldInfo{"search radius for further landmarks from that pose, at the finest pyramid level",
                  "px",
                  1,
                  100});
    visit(
        "local_keyframes",
        self.local_keyframes,
        FieldInfo{"number of key frames whose landmarks are searched from that pose", "", 1, 1000});
    visit("min_inliers",
          self.min_inliers,
          FieldInfo{"number of landmarks that must be found", "", 4, 1000});
    visit("min_share",
          self.min_share,
          FieldInfo{"share of the landmarks expected at the pose that must be found", "", 0, 2});
    visit(
        "new_world_after_frames",
        self.new_world_after_frames,
        common_setting(FieldInfo{
            "number of lost frames after which a new submap begins; a loop joins it to the others",
            "frames",
            1,
            1000000000}));
    visit.group("appearance_match", self.appearance_match);
    visit.group("search_match", self.search_match);
  }
};

/// The result of a relocalisation.
struct Relocalization {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  std::vector<std::pair<std::uint32_t, LandmarkId>> matches;  ///< (feature, landmark), inliers
  /// The ratio of the matched landmarks of the key frame to those that tracking would match there,
  /// each weighted by the share of frames in which tracking found it when expected. About 1 at a
  /// known place.
  double share = 0;
};

/// Finds the pose of a frame without a prediction.
///
/// Each key frame that looks like the frame is matched by appearance. RANSAC finds the pose from
/// three matches with depth that most matches agree with, including those without depth. The pose
/// is refined, more landmarks are searched from it, and it is refined with them. Many of the
/// landmarks that should be visible must be matched, since another place may have some objects in
/// common with a known one.
class Relocalizer {
 public:
  Relocalizer(const RelocalizerConfig& config,
              const CameraModel& camera,
              MeasurementModel measure,
              std::uint32_t seed);

  /// The place with the most matched landmarks among the key frames that look most like the frame.
  /// Nothing when no place fits. `places` has key frames of the map.
  [[nodiscard]] std::optional<Relocalization> find(FrameId frame,
                                                   const Features& features,
                                                   const Map& map,
                                                   const PlaceIndex& places) const;

 private:
  struct Match {
    std::uint32_t feature;
    LandmarkId landmark;
    PoseObservation observation;
  };
  using Matches = std::vector<Match>;
  struct Pose {
    Eigen::Isometry3d T_camera_world;
    Matches inliers;
  };

  [[nodiscard]] std::optional<Relocalization> verify(FrameId frame,
                                                     const Features& features,
                                                     const Map& map,
                                                     const Keyframe& keyframe) const;
  [[nodiscard]] Match make_match(const Features& features,
                                 std::uint32_t feature,
                                 LandmarkId landmark,
                                 const Map& map) const;
  [[nodiscard]] Matches match(const Features& features,
                              const Keyframe& keyframe,
                              const Map& map) const;
  [[nodiscard]] Matches agreeing(const Matches& matches,
                                 const Eigen::Isometry3d& T_camera_world) const;
  [[nodiscard]] std::optional<Eigen::Isometry3d> sample_pose(FrameId frame,
                                                             const Features& features,
                                                             const Keyframe& keyframe,
                                                             const Matches& matches) const;
  [[nodiscard]] std::vector<LandmarkId> local_landmarks(const Keyframe& keyframe,
                                                        const Map& map) const;
  [[nodiscard]] Matches search(const Features& features,
                               const Map& map,
                               std::span<const LandmarkId> landmarks,
                               const Eigen::Isometry3d& T_camera_world,
                               double radius_px) const;
  [[nodiscard]] Pose optimize(const Eigen::Isometry3d& initial, const Matches& matches) const;
  [[nodiscard]] double share_found(const Features& features,
                                   const Map& map,
                                   const Keyframe& keyframe,
                                   const Pose& pose) const;

  RelocalizerConfig config_;
  CameraModel camera_;
  MeasurementModel measure_;
  std::uint32_t seed_;
};

}  // namespace stillmap
