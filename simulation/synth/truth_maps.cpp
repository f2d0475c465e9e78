// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/truth_maps.hpp"

#include "stillmap/core/error.hpp"

namespace stillmap {

TruthMaps::TruthMaps(const CameraModel& camera,
                     std::span<const int> moved_ids,
                     const TruthMapOptions& options)
    : options_(options),
      rays_(pixel_rays(camera)),
      static_(options.voxel_size_m),
      dynamic_(options.voxel_size_m) {
  STILLMAP_CHECK(options.step_px > 0 && options.min_depth_m > 0);
  for (const int id : moved_ids) {
    STILLMAP_CHECK(id > 0 && id < 256);
    moved_[static_cast<std::size_t>(id)] = true;
  }
}

void TruthMaps::add(const ColorImage& color,
                    const DepthImage& depth,
                    const ObjectMask& ids,
                    const Eigen::Isometry3d& T_world_camera) {
  STILLMAP_CHECK(color.mat.size() == rays_.size() && depth.mat.size() == rays_.size() &&
                 ids.mat.size() == rays_.size() && T_world_camera.matrix().allFinite());
  const Eigen::Matrix3f R_world_camera = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_world_camera.translation().cast<float>();
  const float min_depth = static_cast<float>(options_.min_depth_m);
  const float max_depth = static_cast<float>(options_.max_depth_m);
  // The sampled pixels change from frame to frame, so that a still camera covers all of them, too.
  const int step = options_.step_px;
  const int first_u = frames_ % step;
  const int first_v = frames_ / step % step;
  ++frames_;
  for (int v = first_v; v < rays_.rows; v += step) {
    const float* depth_row = depth.mat[v];
    const cv::Vec2f* ray_row = rays_[v];
    const std::uint8_t* id_row = ids.mat[v];
    const cv::Vec3b* color_row = color.mat[v];
    for (int u = first_u; u < rays_.cols; u += step) {
      const float z = depth_row[u];
      if (!(z >= min_depth && z <= max_depth)) continue;
      const Eigen::Vector3f p_camera(ray_row[u][0] * z, ray_row[u][1] * z, z);
      const cv::Vec3b& rgb = color_row[u];
      SurfaceVoxels& voxels = moved_[id_row[u]] ? dynamic_ : static_;
      voxels.add(R_world_camera * p_camera + origin, {rgb[0], rgb[1], rgb[2]});
    }
  }
}

PointCloud TruthMaps::dynamic_map() const {
  return points_clear_of(dynamic_.extract(), static_.extract(), options_.clearance_m);
}

}  // namespace stillmap
