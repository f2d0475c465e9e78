// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/dense/compact_cloud.hpp"
#include "stillmap/dense/cube_moves.hpp"

namespace stillmap {

/// The cloud of a view (see local_cloud) with the view's pose.
struct PosedCloud {
  Eigen::Isometry3d T_world_camera;
  const CompactCloud* cloud;  ///< not null; not owned
};

/// The union of the clouds in the world frame (Fan 2020, section III, Eq. (1)), thinned by
/// VoxelGrid to one point per voxel: mean position and colour, winning label. A cloud without
/// labels counts as label 0; normals are dropped. `moves` displace each point first, one after the
/// other. The same bits with any number of threads.
[[nodiscard]] PointCloud global_cloud(std::span<const PosedCloud> clouds,
                                      double voxel_size_m,
                                      std::size_t threads = 1,
                                      std::span<const CubeMoves> moves = {});

}  // namespace stillmap
