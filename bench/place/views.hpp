// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// An image of a place, with the pose at which it was taken.
struct PlaceView {
  std::string room;
  double time_s = 0;  ///< since the sequence began
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  FeaturesPtr features;
  CameraModel camera;
};

/// Every `gap`-th frame of a sequence that has a true pose. `text`: ROOM=FOLDER, or
/// ROOM@CAMERA=FOLDER where the folder does not tell its camera.
[[nodiscard]] std::vector<PlaceView> read_views(const std::string& text, std::size_t gap);

enum class Relation { kSame, kNeither, kDifferent };

/// Same: one room, less than 0.5 m and 30 degrees apart. Different: two rooms, or more than 1.5 m
/// or 60 degrees apart, which leaves little in common. In between there is no right answer, and
/// none where two rooms (HOUSE.ROOM) of one house have the same furniture at this place.
[[nodiscard]] Relation relation(const PlaceView& a, const PlaceView& b);

[[nodiscard]] double angle_deg(const PlaceView& a, const PlaceView& b);

}  // namespace stillmap
