// SPDX-License-Identifier: Apache-2.0
#include "stillmap/cloud/global_cloud.hpp"

#include "stillmap/cloud/voxel_grid.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {

PointCloud global_cloud(std::span<const PosedCloud> clouds, double voxel_size_m) {
  VoxelGrid grid(voxel_size_m);
  for (const PosedCloud& posed : clouds) {
    STILLMAP_CHECK(posed.cloud != nullptr);
    const CompactCloud& cloud = *posed.cloud;
    STILLMAP_CHECK(cloud.colors.size() == cloud.size());
    STILLMAP_CHECK(cloud.labels.empty() || cloud.labels.size() == cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d p_world = posed.T_world_camera * cloud.position(i).cast<double>();
      const std::uint8_t label = cloud.labels.empty() ? std::uint8_t{0} : cloud.labels[i];
      grid.add(p_world.cast<float>(), cloud.colors[i], label);
    }
  }
  return grid.extract();
}

}  // namespace stillmap
