// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/map/landmark.hpp"

namespace stillmap {

/// Whether a point in camera coordinates is in front of the camera and inside the image.
[[nodiscard]] bool in_view(const CameraModel& camera, const Eigen::Vector3d& p_camera);

/// The projection of a landmark into a camera, with a search radius of `radius_px` scaled to its
/// predicted pyramid level. Nothing if the landmark is out of view, too near or too far for the
/// pyramid, or seen from more than 60 degrees off its mean viewing direction.
[[nodiscard]] std::optional<Projection> project_landmark(const CameraModel& camera,
                                                         const std::vector<float>& level_scales,
                                                         const Eigen::Isometry3d& T_camera_world,
                                                         const Landmark& landmark,
                                                         double radius_px);

/// The greatest difference of measured and predicted inverse depth for a match. It is generous,
/// because the pose may be inaccurate, and only rejects clearly different surfaces.
[[nodiscard]] float inverse_depth_gate(double inverse_depth);

}  // namespace stillmap
