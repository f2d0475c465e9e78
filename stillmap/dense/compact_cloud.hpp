// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// A cloud in some 60 % of the memory: coordinates have 16 bits each over the cloud's extent, 0.1
/// mm where that is 6 m. `places` and `colors` have equal length; `labels` is empty or of that
/// length too.
struct CompactCloud {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< least coordinates, metres
  Eigen::Vector3f step = Eigen::Vector3f::Zero();    ///< metres
  std::vector<std::array<std::uint16_t, 3>> places;  ///< in steps from the origin
  std::vector<Rgb> colors;
  std::vector<std::uint8_t> labels;  ///< class of the surface, 0 = none

  [[nodiscard]] std::size_t size() const { return places.size(); }
  [[nodiscard]] bool empty() const { return places.empty(); }
  [[nodiscard]] Eigen::Vector3f position(std::size_t i) const {
    const std::array<std::uint16_t, 3>& place = places[i];
    return origin + step.cwiseProduct(Eigen::Vector3f(place[0], place[1], place[2]));
  }
};

/// Each coordinate to half a step, a step being 1/65535 of the cloud's extent along its axis.
/// Positions are finite; normals are left out.
[[nodiscard]] CompactCloud compact(const PointCloud& cloud);

}  // namespace stillmap
