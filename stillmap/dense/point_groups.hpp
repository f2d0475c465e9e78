// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// Points grouped by small cubes.
struct PointGroups {
  std::vector<Eigen::Vector3f>
      means;  ///< mean of each group; neighbouring groups mostly follow each other
  std::vector<std::uint32_t> group_of;  ///< the group of each point
};

/// Groups the points of each cube of edge `cell_m` (> 0). Groups are ordered along a space-filling
/// curve (Morton 1966), so that some hundred consecutive groups are near each other. Points that
/// are not finite or more than 2^20 cells from the origin share one group. Takes time linear in the
/// number of points.
[[nodiscard]] PointGroups group_points(std::span<const Eigen::Vector3f> points, double cell_m);

}  // namespace stillmap
