// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace stillmap {

/// Ways to move a hand-held camera through the room of make_room(), named after the TUM RGB-D
/// sequences that they resemble; about 0.2 to 0.3 m/s and 10 to 20 deg/s.
enum class PathKind {
  kXyz,         ///< back and forth along all three axes, hardly turning
  kRpy,         ///< roll, pitch and yaw, almost in place
  kHalfsphere,  ///< over a half sphere of one metre diameter, looking at the desk
  kStatic,      ///< held still by hand: millimetres and tenths of a degree
  kLoop,        ///< around the room's middle, looking outwards; one round in loop_period_s()
};

/// The duration of one round of PathKind::kLoop, seconds. The path repeats exactly after it.
[[nodiscard]] double loop_period_s();

/// The camera's pose at a time; infinitely smooth in time, defined for every finite `t_s`.
[[nodiscard]] Eigen::Isometry3d T_world_camera(PathKind kind, double t_s);

}  // namespace stillmap
