// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct SpaceOptions {
  double resolution_m = 0.05;  ///< edge of a voxel
  double max_range_m = 6.0;    ///< greatest distance from a camera of known free space
};

/// A known voxel: it has points of the map, or a camera saw through it. All other voxels are
/// unknown.
struct SpaceVoxel {
  Eigen::Vector3i index;     ///< covers [index, index + 1) * resolution_m
  std::uint16_t points = 0;  ///< thinned to half a voxel: up to 8; 0: free
  std::uint16_t views = 0;   ///< number of cameras that see its surface or, if free, through it
  [[nodiscard]] bool occupied() const { return points > 0; }
};

struct ObservedSpace {
  double resolution_m = 0.05;
  std::vector<SpaceVoxel> voxels;  ///< without repetition; the same order for the same input
};

/// The voxels or cells asked for are too small for the map.
class ResolutionError : public Error {
 public:
  using Error::Error;
};

/// Occupied and free space from a map and the poses of its cameras. A voxel with points is
/// occupied, even if rays pass it. A voxel without points is free if the ray from a camera to a
/// visible point (see visible_points) passes it before the first occupied voxel.
///
/// Surfaces that no depth image showed (glass, black screens) hide nothing. Throws ResolutionError
/// for points over 2^15 voxels from the origin, and when more than 2^27 voxels are touched.
[[nodiscard]] ObservedSpace observe_space(std::span<const Eigen::Vector3f> p_world,
                                          std::span<const Eigen::Isometry3d> T_world_camera,
                                          const CameraModel& camera,
                                          const SpaceOptions& options);

}  // namespace stillmap
