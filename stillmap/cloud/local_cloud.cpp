// SPDX-License-Identifier: Apache-2.0
#include "stillmap/cloud/local_cloud.hpp"

#include "stillmap/cloud/voxel_grid.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {

PointCloud local_cloud(const RgbdFrame& frame,
                       const cv::Mat2f& rays,
                       const LocalCloudConfig& config) {
  const cv::Mat1f& depth = frame.depth.mat;
  const cv::Mat3b& color = frame.color.mat;
  STILLMAP_CHECK(depth.size() == rays.size() && color.size() == rays.size());
  const auto max_depth = static_cast<float>(config.max_depth_m);
  VoxelGrid grid(config.voxel_size_m);
  for (int row = 0; row < depth.rows; ++row) {
    const float* z = depth[row];
    const cv::Vec2f* ray = rays[row];
    const cv::Vec3b* rgb = color[row];
    for (int x = 0; x < depth.cols; ++x) {
      if (!(z[x] > 0 && z[x] <= max_depth)) continue;  // so written, NaN is left out too
      grid.add({ray[x][0] * z[x], ray[x][1] * z[x], z[x]}, {rgb[x][0], rgb[x][1], rgb[x][2]});
    }
  }
  return grid.extract();
}

}  // namespace stillmap
