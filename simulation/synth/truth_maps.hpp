// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "simulation/synth/surface_voxels.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

struct TruthMapOptions {
  double voxel_size_m = 0.01;
  double clearance_m = 0.05;  ///< what moved objects swept keeps away from static surface
  double min_depth_m = 0.5;   ///< surface nearer than this is not seen
  double max_depth_m = 8.0;   ///< nor farther
  int step_px = 2;            ///< every frame adds each step-th column and row, not always the same
};

/// Gathers, from perfect frames, the static surface that was seen and what moved objects swept.
/// Points lie exactly on surfaces, in the world of the poses.
class TruthMaps {
 public:
  /// `moved_ids` are the objects that move at any time of the sequence: they are never static,
  /// while all others are, chairs that stay where they are included.
  TruthMaps(const CameraModel& camera,
            std::span<const int> moved_ids,
            const TruthMapOptions& options = {});

  /// Adds a frame as a perfect sensor sees it: exact depth of the rays through the pixels' centres,
  /// 0 where there is none. The images have the camera's size.
  void add(const ColorImage& color,
           const DepthImage& depth,
           const ObjectMask& ids,
           const Eigen::Isometry3d& T_world_camera);

  /// One point a voxel, in the order of voxels. The same frames in the same order give equal bits.
  [[nodiscard]] PointCloud static_map() const { return static_.extract(); }

  /// The same of moved objects, without what lies within the clearance of a point of static_map().
  [[nodiscard]] PointCloud dynamic_map() const;

 private:
  TruthMapOptions options_;
  cv::Mat2f rays_;
  std::array<bool, 256> moved_{};
  int frames_ = 0;
  SurfaceVoxels static_;
  SurfaceVoxels dynamic_;
};

}  // namespace stillmap
