// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/truth_maps.hpp"

#include <algorithm>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kFirstThing = 10;  // of the ids; people have those below

void append(PointCloud& cloud, const PointCloud& part) {
  cloud.positions.insert(cloud.positions.end(), part.positions.begin(), part.positions.end());
  cloud.colors.insert(cloud.colors.end(), part.colors.begin(), part.colors.end());
}

}  // namespace

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
                    const Eigen::Isometry3d& T_world_camera,
                    std::span<const int> moving_ids) {
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
  note_motion(moving_ids);
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
      const Eigen::Vector3f p_world = R_world_camera * p_camera + origin;
      const Rgb point_color = {rgb[0], rgb[1], rgb[2]};
      SurfaceVoxels& voxels = moved_[id_row[u]] ? dynamic_ : static_;
      voxels.add(p_world, point_color);
      if (!moved_[id_row[u]] || id_row[u] < kFirstThing) continue;
      if (Standing* at = standing(id_row[u], moving_ids)) at->surface.add(p_world, point_color);
    }
  }
}

void TruthMaps::note_motion(std::span<const int> moving_ids) {
  for (const int id : moving_ids) {
    const auto known = standing_.find(id);
    if (known != standing_.end()) known->second.moved_since = true;
  }
}

/// The place of a thing that is seen; none while it moves.
TruthMaps::Standing* TruthMaps::standing(int id, std::span<const int> moving_ids) {
  const auto known = standing_.find(id);
  const bool moves = std::ranges::find(moving_ids, id) != moving_ids.end();
  if (known != standing_.end() && known->second.moved_since) standing_.erase(known);
  if (moves) return nullptr;
  return &standing_.try_emplace(id, Standing{SurfaceVoxels(options_.voxel_size_m)}).first->second;
}

PointCloud TruthMaps::resting_map() const {
  PointCloud all;
  for (const auto& [id, standing] : standing_) append(all, standing.surface.extract());
  return points_clear_of(all, static_.extract(), options_.clearance_m);
}

PointCloud TruthMaps::dynamic_map() const {
  return points_clear_of(dynamic_.extract(), static_.extract(), options_.clearance_m);
}

}  // namespace stillmap
