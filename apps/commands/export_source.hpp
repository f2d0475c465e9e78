// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// What a run has left behind, as far as exports need it.
struct FinishedRun {
  PointCloud map;  ///< not empty
  std::vector<Eigen::Isometry3d> T_world_keyframe;
  std::optional<CameraModel> camera;  ///< where rays are needed
};

/// Reads a run's folder, or a saved session, whose map is made anew from its views: that of the
/// submap with most frames. `camera`: instead of the run's own, unless empty. Throws Error for what
/// is neither, or lacks something.
[[nodiscard]] FinishedRun read_finished_run(const std::filesystem::path& source,
                                            const std::string& camera,
                                            bool with_camera);

}  // namespace stillmap
