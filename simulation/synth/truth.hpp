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

/// Something in a rendered world that can move, or has a class worth telling.
struct TruthObject {
  int id = 0;              ///< in the masks, 1 to 255
  std::string class_name;  ///< of COCO where that has one
  std::string name;
  bool movable = false;
  bool moved = false;  ///< at any time of the sequence
};

/// An object in one frame.
struct TruthFrameObject {
  int id = 0;
  PixelBox box;          ///< tight around its pixels; meaningless where it has none
  int pixels = 0;        ///< how many show it
  bool moving = false;   ///< in this very frame
  double speed_mps = 0;  ///< mean over its surface
};

/// The objects of a world in one frame, those out of sight included.
struct TruthFrame {
  Stamp stamp;
  std::vector<TruthFrameObject> objects;
};

/// How fast an object is while a frame is taken.
struct ObjectSpeed {
  int id = 0;
  double speed_mps = 0;
};

/// What is slower than this is not moving.
inline constexpr double kMovingSpeedMps = 0.02;

/// Boxes and numbers of pixels of the objects of `speeds`, in that order. Every id in `ids` must be
/// one of them.
[[nodiscard]] std::vector<TruthFrameObject> frame_objects(const ObjectMask& ids,
                                                          std::span<const ObjectSpeed> speeds);

/// The content of truth/objects.json. The same values give the same bytes.
[[nodiscard]] std::string format_objects_json(const CameraModel& camera,
                                              std::span<const TruthObject> objects,
                                              std::span<const TruthFrame> frames);

/// Which share of a surface, given by points spread over it, lies before the camera and within the
/// borders of its image, in [0, 1]; whether something stands in front does not count. 0 without
/// points.
[[nodiscard]] double share_in_view(std::span<const Eigen::Vector3f> p_world,
                                   const CameraModel& camera,
                                   const Eigen::Isometry3d& T_world_camera);

}  // namespace stillmap
