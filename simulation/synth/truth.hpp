// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// An object of a rendered world that can move or has a class.
struct TruthObject {
  int id = 0;              ///< in the masks, 1 to 255
  std::string class_name;  ///< the COCO name if there is one
  std::string name;
  bool movable = false;
  bool moved = false;  ///< at any time of the sequence
};

/// An object in one frame.
struct TruthFrameObject {
  int id = 0;
  PixelBox box;          ///< tight around its pixels; meaningless without pixels
  int pixels = 0;        ///< number of its pixels
  bool moving = false;   ///< in this frame
  double speed_mps = 0;  ///< mean over its surface
};

/// The objects of a world in one frame, including invisible ones.
struct TruthFrame {
  Stamp stamp;
  std::vector<TruthFrameObject> objects;
};

/// The speed of an object in a frame.
struct ObjectSpeed {
  int id = 0;
  double speed_mps = 0;
};

/// The least speed of a moving object.
inline constexpr double kMovingSpeedMps = 0.02;

/// The boxes and numbers of pixels of the objects of `speeds`, in that order. Every id in `ids`
/// must be one of theirs.
[[nodiscard]] std::vector<TruthFrameObject> frame_objects(const ObjectMask& ids,
                                                          std::span<const ObjectSpeed> speeds);

/// The content of truth/objects.json. The same values give the same bytes.
[[nodiscard]] std::string format_objects_json(const CameraModel& camera,
                                              std::span<const TruthObject> objects,
                                              std::span<const TruthFrame> frames);

/// The share of a surface, sampled by points, that is in front of the camera and within the borders
/// of its image, in [0, 1]. Occlusion is ignored. 0 without points.
[[nodiscard]] double share_in_view(std::span<const Eigen::Vector3f> p_world,
                                   const CameraModel& camera,
                                   const Eigen::Isometry3d& T_world_camera);

}  // namespace stillmap
