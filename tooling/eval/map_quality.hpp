// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// "Near" for the figures of a map, metres: at most this far.
inline constexpr double kMapNear_m = 0.05;
/// All clouds are thinned to voxels of this edge before they are compared.
inline constexpr double kMapVoxel_m = 0.02;
/// Neighbouring ghost voxels are a cluster from this number on.
inline constexpr std::size_t kGhostClusterVoxels = 50;
/// Points farther from the origin than this along an axis are no map of a place.
inline constexpr double kMapExtent_m = 10'000;

/// The traces of what moved: map points near dynamic truth and not near static truth.
struct GhostFigures {
  std::optional<double> ratio;  ///< of the map's points; nothing for an empty map
  double volume_l = 0;          ///< of their voxels, litres
  std::size_t clusters = 0;     ///< groups that touch by face, edge or corner
};

/// How good a map is by truth. Points are those of thinned clouds.
struct MapQuality {
  std::size_t voxels = 0;            ///< points of the thinned map
  double sa = 0;                     ///< share of static truth with map near it
  std::optional<double> da;          ///< share of dynamic truth without; nothing without such truth
  std::optional<double> aa;          ///< geometric mean of sa and da
  std::optional<double> ha;          ///< harmonic mean of sa and da
  std::optional<double> accuracy_m;  ///< mean distance map -> static truth; nothing for no map
  std::optional<double> completeness_m;  ///< mean distance static truth -> map; nothing for no map
  std::optional<GhostFigures> ghosts;    ///< nothing when dynamic truth is not known
  std::optional<double> off_ratio_5cm;   ///< share of map farther than 5 cm from static truth
  std::optional<double> off_ratio_10cm;
};

/// What is seen of a map's world in truth, in the frame of its poses.
struct MapTruth {
  PointCloud static_surface;          ///< not empty
  std::optional<PointCloud> dynamic;  ///< what moved things swept; may be empty: nothing moved
};

/// Throws Error, naming the cloud, when a point is not finite or beyond kMapExtent_m.
void check_extent(const PointCloud& cloud, const std::string& name);

/// Compares a map with the truth, in whose frame it is. Deterministic; seconds for clouds of some
/// million points. All clouds pass check_extent().
[[nodiscard]] MapQuality map_quality(const PointCloud& map, const MapTruth& truth);

}  // namespace stillmap
