// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/pose_time.hpp"

#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

Features at_pose_time(Features features, const CameraModel& camera, const FeatureTiming& timing) {
  const double depth_after_s = timing.depth_after_color_s();
  for (std::size_t i = 0; i < features.size(); ++i) {
    const bool known = features.sensor_depth_m[i] > 0;
    const Eigen::Vector2d ideal_px = features.ideal_px[i].cast<double>();
    double depth_m = 1.0;
    if (known) {
      const double late_m = static_cast<double>(features.sensor_depth_m[i]);
      const Eigen::Vector3d p_late = camera.unproject(ideal_px, late_m);
      depth_m = late_m - depth_after_s * timing.velocity.of_point(p_late).z();
    }
    const Eigen::Vector3d p = camera.unproject(ideal_px, depth_m);
    const double after_middle_s =
        row_position(features.raw_px[i], camera) * timing.assumed.readout_s;
    const Eigen::Vector3d p_middle =
        p - after_middle_s * corrected_velocity(timing.velocity, known).of_point(p);
    if (p_middle.z() < kMinPointDepth) continue;
    features.px[i] = camera.project(p_middle).cast<float>();
    features.depth_m[i] = known ? static_cast<float>(p_middle.z()) : 0.0F;
  }
  features.grid = FeatureGrid(features.px, camera.width_px, camera.height_px);
  return features;
}

}  // namespace stillmap
