// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// The greatest distance, metres, that counts as near in the figures.
inline constexpr double kMapNear_m = 0.05;
/// The edge of the voxels, metres, to which all clouds are thinned before comparison.
inline constexpr double kMapVoxel_m = 0.02;
/// The least number of touching ghost voxels that form a cluster.
inline constexpr std::size_t kGhostClusterVoxels = 50;
/// The greatest coordinate, metres, of a valid map.
inline constexpr double kMapExtent_m = 10'000;

/// The ghosts: map points near dynamic truth and not near static truth.
struct GhostFigures {
  std::optional<double> ratio;  ///< share of the map's points; nothing for an empty map
  double volume_l = 0;          ///< of their voxels, litres
  std::size_t clusters = 0;     ///< groups that touch by face, edge or corner
};

/// The quality of a map against truth. Points are those of the thinned clouds.
struct MapQuality {
  std::size_t voxels = 0;  ///< points of the thinned map
  double sa = 0;           ///< share of static truth with map near it
  std::optional<double>
      da;  ///< share of dynamic truth without map near it; nothing without such truth
  std::optional<double> aa;  ///< geometric mean of sa and da
  std::optional<double> ha;  ///< harmonic mean of sa and da
  std::optional<double>
      accuracy_m;  ///< mean distance map -> static truth; nothing for an empty map
  std::optional<double>
      completeness_m;  ///< mean distance static truth -> map; nothing for an empty map
  std::optional<GhostFigures> ghosts;   ///< nothing without dynamic truth
  std::optional<double> off_ratio_5cm;  ///< share of map farther than 5 cm from static truth
  std::optional<double> off_ratio_10cm;
};

/// The true surfaces that the camera saw, in the coordinate frame of the ground truth.
struct MapTruth {
  PointCloud static_surface;          ///< not empty
  std::optional<PointCloud> dynamic;  ///< surface swept by moving objects; empty if nothing moved
  /// Moved things where they were last seen to stand. A map may have them there or not: dynamic
  /// truth near them does not count, nor do map points near them that are not near static truth.
  std::optional<PointCloud> resting = std::nullopt;
};

/// Throws Error, naming the cloud, when a point is not finite or beyond kMapExtent_m.
void check_extent(const PointCloud& cloud, const std::string& name);

/// Compares a map with the truth. Both are in the coordinate frame of the ground truth and pass
/// check_extent(). Deterministic. Takes seconds for clouds of some million points.
[[nodiscard]] MapQuality map_quality(const PointCloud& map, const MapTruth& truth);

}  // namespace stillmap
