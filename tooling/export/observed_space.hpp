// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct SpaceOptions {
  double resolution_m = 0.05;  ///< edge of a voxel
  double max_range_m = 6.0;    ///< free space is known no farther than that from a camera
};

/// A voxel of which something is known: it holds points of the map, or a camera has seen through
/// it. All others are unknown.
struct SpaceVoxel {
  Eigen::Vector3i index;     ///< covers [index, index + 1) * resolution_m
  std::uint16_t points = 0;  ///< thinned to half a voxel: up to 8; 0: free
  std::uint16_t views = 0;   ///< how many cameras see its surface, or, when free, through it
  [[nodiscard]] bool occupied() const { return points > 0; }
};

struct ObservedSpace {
  double resolution_m = 0.05;
  std::vector<SpaceVoxel> voxels;  ///< each once, the same order for the same input
};

/// What a map and the places of the cameras that made it say of space. A voxel with points is
/// occupied, whatever the rays say: the map is what the run holds to be true. A voxel without is
/// free when a ray from a camera passes it on the way to a point that is in view (see
/// visible_points) before it meets an occupied voxel.
///
/// Surfaces that no depth image showed (glass, black screens) hide nothing. Throws Error for points
/// over 2^15 voxels from the origin, or when more space than 2^27 voxels is touched, naming
/// --resolution.
[[nodiscard]] ObservedSpace observe_space(std::span<const Eigen::Vector3f> p_world,
                                          std::span<const Eigen::Isometry3d> T_world_camera,
                                          const CameraModel& camera,
                                          const SpaceOptions& options);

}  // namespace stillmap
