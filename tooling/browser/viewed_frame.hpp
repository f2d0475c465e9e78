// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/system/results.hpp"

namespace stillmap {

/// An object as pages show it. World coordinates, metres.
struct ViewedObject {
  std::uint32_t track = 0;
  std::string class_name;
  bool dynamic = false;
  std::string motion;  ///< motion_name()
  PixelBox box;
  std::optional<Eigen::Vector3d> p_world;  ///< the middle of its visible surface
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  /// Right, down and forward in the camera that saw it; 0 where unknown.
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
};

/// What pages show of a frame.
struct ViewedFrame {
  std::uint32_t number = 0;  ///< in its sequence
  Stamp stamp;
  TrackingStatus status = TrackingStatus::kLost;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< unless lost
  bool keyframe = false;
  double pose_ms = 0;
  int tracked_features = 0;
  std::vector<ViewedObject> objects;
};

/// The extent of an object whose box is seen at a distance: right and down from the box, forward
/// from its depths, between a tenth of a metre and a metre; half its width where these are unknown.
[[nodiscard]] Eigen::Vector3d seen_size(const PixelBox& box,
                                        double distance_m,
                                        const std::optional<DepthInterval>& depths,
                                        const CameraModel& camera);

/// What pages show of a frame's result.
[[nodiscard]] ViewedFrame viewed_frame(const FrameResult& result, const CameraModel& camera);

/// A JSON list: position in metres, quaternion x y z w, camera to world.
[[nodiscard]] std::string pose_json(const Eigen::Isometry3d& T_world_camera);

/// A JSON object: `{"n","t","s","ms","f"}` (number, stamp in seconds, status, time to the pose,
/// tracked features), `"k":1` for a key frame, `"p"` (position, quaternion x y z w) with a pose,
/// and `"o"` for objects: `{"i","c","b","m"}` (track, class, box, motion), `"d":1` if dynamic, and
/// with a place `"p"`, `"v"` and `"z"` (position, velocity, size).
[[nodiscard]] std::string frame_json(const ViewedFrame& frame);

}  // namespace stillmap
