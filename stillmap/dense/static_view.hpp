// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "stillmap/dense/compact_cloud.hpp"
#include "stillmap/dense/range_image.hpp"

namespace stillmap {

/// What a frame keeps for the map, in its camera's coordinates.
struct StaticView {
  CompactCloud cloud;
  RangeImage range;
};

struct PosedView {
  Eigen::Isometry3d T_world_camera;
  const StaticView* view;  ///< not null; not owned
};

}  // namespace stillmap
