// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/compact_cloud.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {

CompactCloud compact(const PointCloud& cloud) {
  constexpr float kSteps = 65535;
  CompactCloud result;
  result.colors = cloud.colors;
  result.labels = cloud.labels;
  if (cloud.empty()) return result;
  Eigen::Vector3f least = cloud.positions.front(), greatest = least;
  for (const Eigen::Vector3f& p : cloud.positions) {
    STILLMAP_CHECK(p.allFinite());
    least = least.cwiseMin(p);
    greatest = greatest.cwiseMax(p);
  }
  result.origin = least;
  result.step = (greatest - least) / kSteps;
  result.places.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.positions) {
    std::array<std::uint16_t, 3>& place = result.places.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const float step = result.step[axis];
      const float steps = step > 0 ? (p[axis] - least[axis]) / step : 0.0F;
      place[static_cast<std::size_t>(axis)] =
          static_cast<std::uint16_t>(std::clamp(std::round(steps), 0.0F, kSteps));
    }
  }
  return result;
}

}  // namespace stillmap
