// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/status.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

/// The frame from which a frame's objects come.
enum class MaskOrigin : std::uint8_t {
  kOwn,      ///< found in this frame; also in a run without a network
  kAwaited,  ///< carried forward from earlier frames while the network works on this one
  kCarried,  ///< carried forward; the network does not work on this frame
};

/// A feature of a frame and what became of it.
struct FeatureMark {
  Eigen::Vector2f raw_px;                            ///< position in the image, distortion included
  FeatureVerdict verdict = FeatureVerdict::kStable;  ///< of the filter
  bool tracked = false;                              ///< an inlier of the pose
};

/// The result for one frame. Positions and velocities are in the world frame of `T_world_camera`.
/// Images have the frame's size, or are empty where the mode ignores motion.
struct FrameResult {
  FrameId id;                                     ///< of the frame
  Stamp stamp;                                    ///< of the frame
  TrackingStatus status = TrackingStatus::kLost;  ///< whether there is a pose, and how it was found
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< unless lost
  bool is_keyframe = false;                                          ///< it has become a key frame
  int tracked_features = 0;                                          ///< inliers of the pose

  std::vector<FeatureMark> features;               ///< off the masks, and those dropped
  MatchJudge match_judge = MatchJudge::kNotAsked;  ///< what matches in boxes were judged by
  std::vector<ObjectState> objects;                ///< given or filled in
  ObjectMask object_mask;                          ///< pixels of all of them: i + 1 is objects[i]
  ObjectMask network_mask;                         ///< pixels of dynamic objects, by the network
  ObjectMask extended_mask;                        ///< the same after the extension by depth
  Mask depth_jumps;                                ///< pixels whose depth has changed suddenly
  Mask excluded;  ///< pixels that no feature may have: masks, jumps and a margin

  double pose_ms = 0;  ///< of all work that leads to the pose, preparation included
  /// In the order of the stages. "mapping" includes waiting for it, "dynamics" and "features" their
  /// preparation.
  std::vector<StageTime> stages;
};

/// Whether T_world_camera is known.
[[nodiscard]] inline bool has_pose(const FrameResult& frame) {
  return frame.status != TrackingStatus::kLost;
}

/// A loop that was closed: the stamps of the key frames that saw one place.
struct ClosedLoop {
  Stamp earlier;  ///< of the first visit
  Stamp later;    ///< of the return
};

/// The results of a finished run, under final poses.
struct RunResult {
  /// The run's tracked frames in the submap that has most of them. The other frames were tracked,
  /// after a loss, in other submaps that no known place has joined to this one.
  Trajectory trajectory;
  std::size_t frames_elsewhere = 0;  ///< tracked, but in another submap
  Trajectory keyframes;              ///< of that submap, including those of a continued session
  PointCloud map;                    ///< of that submap
  std::vector<ClosedLoop> loops;     ///< closed in this run
  bool lost_at_end = false;          ///< the last frame has no pose
  /// The tracks in frames' results that turned out to be of one object, in the order of finding.
  std::vector<UnitedTracks> united_tracks;
  /// Places in the map that nobody looked at again after their things had come elsewhere. The
  /// things at those that count are not in the map.
  std::vector<VacatedPlace> vacated;
};

}  // namespace stillmap
