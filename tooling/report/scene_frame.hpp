// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "tooling/browser/scene_message.hpp"
#include "tooling/report/map_picture.hpp"

namespace stillmap {

/// The layout of a map, for viewing it. "Level" axes: x right, y down to the floor, z horizontal in
/// the mean viewing direction of the cameras; origin as in the world.
struct SceneFrame {
  Eigen::Matrix3d R_level_world = Eigen::Matrix3d::Identity();
  Eigen::AlignedBox3d box;      ///< level axes; holds the map except strays; empty for no map
  Eigen::AlignedBox3d cameras;  ///< level axes; holds the cameras' places
  double spacing_m = 0.01;      ///< typical distance of neighbouring points
};

/// Estimates the floor's direction from the map, because the world's axes are those of a camera
/// that may have been tilted (up to 45 degrees): the points' heights are most concentrated when
/// floors, tables and ceilings are level. With `up_world` (not zero) that is the direction. Points
/// that are not finite are left out.
[[nodiscard]] SceneFrame scene_frame(const PointCloud& map,
                                     const Trajectory& cameras,
                                     const std::optional<Eigen::Vector3d>& up_world = {});

/// Indexes of the map's points that are finite and not far outside the scene's box, ascending.
[[nodiscard]] std::vector<std::size_t> points_in_scene(const PointCloud& map,
                                                       const SceneFrame& scene);

/// A perspective view of the whole scene, in the direction that is turned from the cameras' by
/// `right` and then by `down`, radians (down: from 0 to under a right angle).
struct GazeTurn {
  double right = 0, down = 0;
};
[[nodiscard]] View view_turned(const SceneFrame& scene,
                               const GazeTurn& turn,
                               int width_px,
                               int height_px);

/// A perspective view along the scene from behind and slightly above the cameras.
[[nodiscard]] View view_along(const SceneFrame& scene, int width_px, int height_px);

/// Level y coordinate slightly above the cameras: points with a smaller y hang over their heads.
/// Without cameras, the top of the map.
[[nodiscard]] double head_height(const SceneFrame& scene);

/// The same for pages.
[[nodiscard]] SceneLayout scene_layout(const SceneFrame& scene);

/// An orthographic view from above, without points that hang over the cameras' heads.
[[nodiscard]] View view_from_above(const SceneFrame& scene, int width_px, int height_px);

}  // namespace stillmap
