// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/view_cone.hpp"

#include <algorithm>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr double kMinDepthM = 0.05;

// Every ideal pixel of the image's border is outside the rectangle or on its edge.
Eigen::AlignedBox2d inner_rectangle(const CameraModel& camera) {
  const double right = camera.width_px - 1.0;
  const double bottom = camera.height_px - 1.0;
  Eigen::AlignedBox2d box(Eigen::Vector2d(0, 0), Eigen::Vector2d(right, bottom));
  if (!camera.distorted()) return box;
  const auto ideal = [&](double u, double v) { return camera.undistort({u, v}); };
  // At most one image size beyond the image, because an extreme distortion has no bounds.
  box =
      Eigen::AlignedBox2d(Eigen::Vector2d(-right, -bottom), Eigen::Vector2d(2 * right, 2 * bottom));
  constexpr int kSteps = 32;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = right * i / kSteps;
    const double v = bottom * i / kSteps;
    box.min().x() = std::max(box.min().x(), ideal(0, v).x());
    box.max().x() = std::min(box.max().x(), ideal(right, v).x());
    box.min().y() = std::max(box.min().y(), ideal(u, 0).y());
    box.max().y() = std::min(box.max().y(), ideal(u, bottom).y());
  }
  if (box.isEmpty()) throw Error("camera {}: its distortion leaves nothing in view", camera.name);
  return box;
}

}  // namespace

ViewCone::ViewCone(const CameraModel& camera) : camera_(camera), box_px_(inner_rectangle(camera)) {}

std::optional<Eigen::Vector2d> ViewCone::pixel(const Eigen::Vector3d& p_camera) const {
  if (!(p_camera.z() > kMinDepthM)) return std::nullopt;
  const Eigen::Vector2d px = camera_.project(p_camera);
  return box_px_.contains(px) ? std::optional<Eigen::Vector2d>(px - box_px_.min()) : std::nullopt;
}

}  // namespace stillmap
