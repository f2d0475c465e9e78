// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/images.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// The camera of a picture. Its axes are x right, y down, z forward; its optical axis goes through
/// the middle of the picture.
struct View {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  int width_px = 960;
  int height_px = 540;
  bool orthographic = false;
  double scale = 600;             ///< focal length in pixels; pixels in a metre when orthographic
  double near_m = 0.05;           ///< points nearer along the optical axis are not drawn
  double point_size_m = 0.01;     ///< edge of the square that a point covers, at least one pixel
  bool shade_depth_steps = true;  ///< darkens pixels at the rim of nearer surface
  Rgb background = {255, 255, 255};
};

/// The transform of a camera at `eye` that looks at `target` (another place), with `down` (not
/// along the gaze) pointing to the lower edge of the picture.
[[nodiscard]] Eigen::Isometry3d look_at(const Eigen::Vector3d& eye,
                                        const Eigen::Vector3d& target,
                                        const Eigen::Vector3d& down);

/// The projection of a point: x and y in pixels (the upper left corner of the picture is 0, 0) and
/// its depth along the optical axis. Nothing when it is nearer than the view's limit or not finite.
[[nodiscard]] std::optional<Eigen::Vector3d> project_point(const View& view,
                                                           const Eigen::Vector3d& p_world);

/// Renders the cloud: the nearest point wins, of equally near ones the first in the cloud. Needs no
/// window and no graphics hardware.
[[nodiscard]] ColorImage render_points(const PointCloud& cloud, const View& view);

/// Indices of the points that are the corners of triangles.
using Triangles = std::span<const std::array<std::uint32_t, 3>>;

/// Renders triangles between the vertices, in the colours of their corners; their size in pixels
/// should be small. The nearest wins. Triangles with a corner nearer than the view's limit are not
/// drawn.
[[nodiscard]] ColorImage render_triangles(const PointCloud& vertices,
                                          Triangles triangles,
                                          const View& view);

/// The positions of the poses, cut at gaps of more than half a second.
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> continuous_parts(const Trajectory& poses);

/// A copy of the picture with a line through the points drawn over it.
[[nodiscard]] ColorImage draw_path(const ColorImage& picture,
                                   const View& view,
                                   std::span<const Eigen::Vector3d> path_world,
                                   Rgb color);

}  // namespace stillmap
