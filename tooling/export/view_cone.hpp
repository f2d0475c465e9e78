// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The field of view of a camera: the image or, with distortion, the largest upright rectangle of
/// ideal pixels inside it; from 5 cm on.
class ViewCone {
 public:
  explicit ViewCone(const CameraModel& camera);

  /// The ideal pixel of a point, relative to the corner of the rectangle; nothing for a point out
  /// of view.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(const Eigen::Vector3d& p_camera) const;

  [[nodiscard]] Eigen::Vector2d size_px() const { return box_px_.sizes(); }

 private:
  CameraModel camera_;
  Eigen::AlignedBox2d box_px_;
};

}  // namespace stillmap
