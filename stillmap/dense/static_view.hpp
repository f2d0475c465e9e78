// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "stillmap/dense/compact_cloud.hpp"
#include "stillmap/dense/range_image.hpp"

namespace stillmap {

/// The part of the dense map that one frame shows, in the coordinates of its camera.
struct StaticView {
  CompactCloud cloud;
  RangeImage range;

  /// The memory of its points and cells.
  [[nodiscard]] std::size_t bytes() const {
    return cloud.places.size() * sizeof(cloud.places[0]) + cloud.colors.size() * sizeof(Rgb) +
           cloud.labels.size() + range.cells.size() * sizeof(RangeCell);
  }
};

struct PosedView {
  Eigen::Isometry3d T_world_camera;
  const StaticView* view;  ///< not null; not owned
};

}  // namespace stillmap
