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

/// Finds the floor of a map whose vertical is unknown. Candidates are planes with flat patches of
/// surface (RANSAC with fixed draws, then least squares) that are at least 20 cm below every
/// camera, within 50 degrees of the horizontal plane of the cameras on average, and have at most
/// one twentieth of the map more than 10 cm below them. The floor is the candidate with the most
/// surface. Nothing when no candidate has half a square metre: the floor was hardly seen, or the
/// cameras were held sideways.
[[nodiscard]] std::optional<FloorPlane> find_floor(
    std::span<const Eigen::Vector3f> p_world, std::span<const Eigen::Isometry3d> T_world_camera);

/// T_grid_world for the coordinate frame of navigation: z up, 0 on the floor, origin below the
/// first camera, x in the direction in which that camera looks (if it looks straight down, that of
/// its upper edge).
[[nodiscard]] Eigen::Isometry3d floor_frame(const FloorPlane& floor,
                                            const Eigen::Isometry3d& T_world_camera);

}  // namespace stillmap
