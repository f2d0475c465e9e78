// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/map/landmark.hpp"

namespace stillmap {

/// A point in camera coordinates is in view: before the camera and inside the image.
[[nodiscard]] bool in_view(const CameraModel& camera, const Eigen::Vector3d& p_camera);

/// Where a camera should see the landmark, with a search radius of `radius_px` at the scale it is
/// expected on. Nothing when it is out of view, too near or far for the pyramid, or seen from more
/// than 60 degrees off the directions it was seen from.
[[nodiscard]] std::optional<Projection> project_landmark(const CameraModel& camera,
                                                         const std::vector<float>& level_scales,
                                                         const Eigen::Isometry3d& T_camera_world,
                                                         const Landmark& landmark,
                                                         double radius_px);

/// How far a measured inverse depth may be from the expected one for a match: generous, for the
/// pose may be off; it only rejects what is clearly another surface.
[[nodiscard]] float inverse_depth_gate(double inverse_depth);

}  // namespace stillmap
