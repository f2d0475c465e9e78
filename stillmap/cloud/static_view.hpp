// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/cloud/range_image.hpp"
#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// What a frame keeps for the map, in its camera's coordinates.
struct StaticView {
  PointCloud cloud;
  RangeImage range;  ///< empty when free space is not asked for
};

}  // namespace stillmap
