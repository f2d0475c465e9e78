// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
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
  double clearance_m = 0.05;  ///< distance of the swept surface from static surface
  double min_depth_m = 0.5;   ///< least depth of visible surface
  double max_depth_m = 8.0;   ///< greatest depth of visible surface
  int step_px = 2;  ///< every frame adds each step-th column and row, with varying offsets
};

/// Collects from perfect frames the visible static surface and the surface swept by moving objects.
/// Points are exactly on surfaces, in the world frame of the poses.
class TruthMaps {
 public:
  /// `moved_ids` are the objects that move at any time of the sequence. They are never static; all
  /// others are, including chairs that stay in place.
  TruthMaps(const CameraModel& camera,
            std::span<const int> moved_ids,
            const TruthMapOptions& options = {});

  /// Adds a frame of a perfect sensor: exact depth at the pixels' centres, 0 if there is none.
  /// Images have the camera's size. `moving_ids` are the objects that move in this frame, in view
  /// or not.
  void add(const ColorImage& color,
           const DepthImage& depth,
           const ObjectMask& ids,
           const Eigen::Isometry3d& T_world_camera,
           std::span<const int> moving_ids = {});

  /// The static surface, one point per voxel, in the order of voxels. The same frames in the same
  /// order give equal bits.
  [[nodiscard]] PointCloud static_map() const { return static_.extract(); }

  /// The surface swept by moving objects, without points within the clearance of static_map().
  [[nodiscard]] PointCloud dynamic_map() const;

  /// Moved things, people excepted, where they were last seen to stand: there a map may have them
  /// or not. A thing that was seen to leave its place, and not to stand since, has none. Without
  /// points within the clearance of static_map().
  [[nodiscard]] PointCloud resting_map() const;

 private:
  /// A thing where it stands.
  struct Standing {
    SurfaceVoxels surface;
    bool moved_since = false;  ///< it was last seen
  };
  void note_motion(std::span<const int> moving_ids);
  [[nodiscard]] Standing* standing(int id, std::span<const int> moving_ids);

  TruthMapOptions options_;
  cv::Mat2f rays_;
  std::array<bool, 256> moved_{};
  int frames_ = 0;
  SurfaceVoxels static_;
  SurfaceVoxels dynamic_;
  std::map<int, Standing> standing_;  ///< by id
};

}  // namespace stillmap
