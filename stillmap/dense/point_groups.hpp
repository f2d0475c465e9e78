// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// Points put together by small cubes.
struct PointGroups {
  std::vector<Eigen::Vector3f> means;   ///< of each group's points; neighbours mostly follow
  std::vector<std::uint32_t> group_of;  ///< of each point
};

/// Groups the points of each cube of edge `cell_m` (> 0), ordered along a space-filling curve
/// (Morton 1966), so that some hundred groups in a row are near each other. Points that are not
/// finite or over 2^20 cells from the origin are in one group. Takes time linear in the number of
/// points.
[[nodiscard]] PointGroups group_points(std::span<const Eigen::Vector3f> points, double cell_m);

}  // namespace stillmap
