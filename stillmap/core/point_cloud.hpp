// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace stillmap {

/// Red, green, blue.
using Rgb = std::array<std::uint8_t, 3>;

/// Points with their attributes, as parallel arrays. `positions` and `colors` have equal length;
/// `labels` and `normals` are empty or have that length too.
struct PointCloud {
  std::vector<Eigen::Vector3f> positions;  ///< metres
  std::vector<Rgb> colors;                 ///< of the surface
  std::vector<std::uint8_t> labels;      ///< class of the surface (COCO, counted from 1), 0 = none
  std::vector<Eigen::Vector3f> normals;  ///< unit length

  /// Number of points.
  [[nodiscard]] std::size_t size() const { return positions.size(); }
  /// Whether there are no points.
  [[nodiscard]] bool empty() const { return positions.empty(); }
};

/// The cloud in coordinate frame `target`: positions are transformed, normals rotated.
[[nodiscard]] inline PointCloud moved(PointCloud cloud, const Eigen::Isometry3d& T_target_cloud) {
  for (Eigen::Vector3f& p : cloud.positions) p = (T_target_cloud * p.cast<double>()).cast<float>();
  const Eigen::Matrix3f R_target_cloud = T_target_cloud.linear().cast<float>();
  for (Eigen::Vector3f& normal : cloud.normals) normal = R_target_cloud * normal;
  return cloud;
}

}  // namespace stillmap
