// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// The points of a cloud whose index fulfils `keep`, with their attributes.
template <class Keep>
[[nodiscard]] PointCloud selected_points(const PointCloud& cloud, const Keep& keep) {
  PointCloud kept;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!keep(i)) continue;
    kept.positions.push_back(cloud.positions[i]);
    kept.colors.push_back(cloud.colors[i]);
    if (!cloud.labels.empty()) kept.labels.push_back(cloud.labels[i]);
    if (!cloud.normals.empty()) kept.normals.push_back(cloud.normals[i]);
  }
  return kept;
}

}  // namespace stillmap
