// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

namespace stillmap {

/// The floor: points with up . p + offset_m = 0.
struct FloorPlane {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit length, away from the ground
  double offset_m = 0.0;

  [[nodiscard]] double height_m(const Eigen::Vector3d& p) const { return up.dot(p) + offset_m; }
};

/// Finds the floor in a map whose vertical is not known: of the planes with flat patches of surface
/// on them (RANSAC, always the same draws, then least squares) the one with the most surface that
/// is at least 20 cm below every camera, within 50 degrees of what the cameras on average hold to
/// be horizontal, and has at most one part in twenty of the map more than 10 cm below it. Nothing
/// when none has half a square metre: the floor was hardly seen, or the cameras were held sideways.
[[nodiscard]] std::optional<FloorPlane> find_floor(
    std::span<const Eigen::Vector3f> p_world, std::span<const Eigen::Isometry3d> T_world_camera);

/// T_grid_world of the frame that navigation uses: z up, 0 on the floor; the origin below the first
/// camera, x where that camera looks (where it looks straight down: where its upper edge points).
[[nodiscard]] Eigen::Isometry3d floor_frame(const FloorPlane& floor,
                                            const Eigen::Isometry3d& T_world_camera);

}  // namespace stillmap
