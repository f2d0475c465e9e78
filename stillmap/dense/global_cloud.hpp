// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/dense/compact_cloud.hpp"

namespace stillmap {

/// A view's cloud (see local_cloud) and where its camera is.
struct PosedCloud {
  Eigen::Isometry3d T_world_camera;
  const CompactCloud* cloud;  ///< not null; not owned
};

/// The union of the clouds in world coordinates (Fan 2020, Eq. (1)), thinned to one point a voxel
/// as VoxelGrid does it: mean position and colour, winning label. A cloud without labels has label
/// 0 everywhere; normals are left out. The same bits with any number of threads.
[[nodiscard]] PointCloud global_cloud(std::span<const PosedCloud> clouds,
                                      double voxel_size_m,
                                      std::size_t threads = 1);

}  // namespace stillmap
