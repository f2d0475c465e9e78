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

/// The results of a run that exports need.
struct FinishedRun {
  PointCloud map;  ///< not empty
  std::vector<Eigen::Isometry3d> T_world_keyframe;
  std::optional<CameraModel> camera;  ///< needed for rays
};

/// Reads a run folder, or a saved session, whose map is made again from its views: that of the main
/// submap. `camera`, unless empty, replaces the camera of the run. Throws Error for a path that is
/// neither, and for missing parts.
[[nodiscard]] FinishedRun read_finished_run(const std::filesystem::path& source,
                                            const std::string& camera,
                                            bool with_camera);

}  // namespace stillmap
