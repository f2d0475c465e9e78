// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// A cloud in about 60 % of the memory of a PointCloud: each coordinate has 16 bits over the
/// cloud's extent, 0.1 mm for 6 m. `places` and `colors` have equal length; `labels` is empty or
/// has that length, too.
struct CompactCloud {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< least coordinates, metres
  Eigen::Vector3f step = Eigen::Vector3f::Zero();    ///< metres
  std::vector<std::array<std::uint16_t, 3>> places;  ///< positions, in steps from the origin
  std::vector<Rgb> colors;
  std::vector<std::uint8_t> labels;  ///< class of the surface, 0 = none

  [[nodiscard]] std::size_t size() const { return places.size(); }
  [[nodiscard]] bool empty() const { return places.empty(); }
  [[nodiscard]] Eigen::Vector3f position(std::size_t i) const {
    const std::array<std::uint16_t, 3>& place = places[i];
    return origin + step.cwiseProduct(Eigen::Vector3f(place[0], place[1], place[2]));
  }
};

/// Compacts a cloud. Coordinates are accurate to half a step; a step is 1/65535 of the cloud's
/// extent along the axis. Positions must be finite; normals are dropped.
[[nodiscard]] CompactCloud compact(const PointCloud& cloud);

}  // namespace stillmap
