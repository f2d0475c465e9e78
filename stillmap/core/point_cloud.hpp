// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

using Rgb = std::array<std::uint8_t, 3>;

/// Points with their attributes, as parallel arrays. `positions` and `colors` have equal length;
/// `labels` and `normals` are either empty or of that length too.
struct PointCloud {
  std::vector<Eigen::Vector3f> positions;  ///< metres
  std::vector<Rgb> colors;
  std::vector<std::uint8_t> labels;      ///< class of the surface, 0 = none
  std::vector<Eigen::Vector3f> normals;  ///< unit length

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool empty() const { return positions.empty(); }
};

}  // namespace stillmap
