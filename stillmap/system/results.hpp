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

/// Whose objects a frame comes with.
enum class MaskOrigin : std::uint8_t {
  kOwn,      ///< those found in it; also where nothing looks for objects
  kAwaited,  ///< carried forward from earlier frames; its own are being looked for
  kCarried,  ///< carried forward; nobody looks for its own
};

/// A feature of a frame and what became of it.
struct FeatureMark {
  Eigen::Vector2f raw_px;  ///< where the image, distortion included, has it
  FeatureVerdict verdict = FeatureVerdict::kStable;  ///< of the filter
  bool tracked = false;                              ///< an inlier of the pose
};

/// All that the system tells of one frame. Positions and velocities are in the frame of
/// `T_world_camera`. Images are of the frame's size, or empty where nothing is done about what
/// moves.
struct FrameResult {
  FrameId id;                                     ///< of the frame
  Stamp stamp;                                    ///< of the frame
  TrackingStatus status = TrackingStatus::kLost;  ///< whether there is a pose, and how it was found
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< unless lost
  bool is_keyframe = false;                                          ///< it has become a key frame
  int tracked_features = 0;                                          ///< inliers of the pose

  std::vector<FeatureMark> features;  ///< off the masks
  std::vector<ObjectState> objects;   ///< those that were given or filled in
  ObjectMask object_mask;             ///< pixels of all of them: i + 1 is objects[i]
  ObjectMask network_mask;            ///< pixels of dynamic objects, as the network has them
  ObjectMask extended_mask;           ///< the same after the extension by depth
  Mask depth_jumps;                   ///< pixels whose depth has changed suddenly
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

/// All that a finished run knows, under final poses.
struct RunResult {
  /// The run's tracked frames in the submap that has most of them. Other frames were tracked after
  /// a loss in a submap of their own, which no known place has joined to this one.
  Trajectory trajectory;
  std::size_t frames_elsewhere = 0;  ///< tracked, but in another submap
  Trajectory keyframes;              ///< of that submap, also those of a session that it continues
  PointCloud map;                    ///< of that submap
  std::vector<ClosedLoop> loops;     ///< closed in this run
  bool lost_at_end = false;          ///< the last frame has no pose
};

}  // namespace stillmap
