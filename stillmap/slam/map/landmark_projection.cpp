// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/landmark_projection.hpp"

#include <algorithm>
#include <optional>

#include "stillmap/slam/features/feature_slope.hpp"
#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {
namespace {

// The pyramid level, at `distance_m`, of a corner that is on level 0 at `max_distance_m`.
int predict_level(const std::vector<float>& level_scales,
                  double max_distance_m,
                  double distance_m) {
  const double ratio = max_distance_m / distance_m;
  const auto at = std::ranges::find_if(
      level_scales, [&](float scale) { return static_cast<double>(scale) >= ratio * 0.999; });
  return static_cast<int>(
      std::min<std::ptrdiff_t>(at - level_scales.begin(), std::ssize(level_scales) - 1));
}

// A wide lens shows much more than the same image without distortion does.
bool wide(const CameraModel& camera) {
  return camera.lens == LensModel::kFisheye || camera.k4 != 0 || camera.k5 != 0 || camera.k6 != 0;
}

// The raw pixel of a feature at an ideal one; none where the lens has no features, or folds back.
std::optional<Eigen::Vector2d> wide_pixel(const CameraModel& camera, const Eigen::Vector2d& ideal) {
  if (camera.unproject(ideal, 1.0).head<2>().norm() > kSteepestFeature) return std::nullopt;
  const Eigen::Vector2d raw = camera.distort(ideal);
  const bool folded = (camera.undistort(raw) - ideal).norm() > 1.0;
  return folded ? std::nullopt : std::optional(raw);
}

}  // namespace

bool in_view(const CameraModel& camera, const Eigen::Vector3d& p_camera) {
  if (p_camera.z() < kMinPointDepth) return false;
  const Eigen::Vector2d ideal = camera.project(p_camera);
  const std::optional<Eigen::Vector2d> px =
      wide(camera) ? wide_pixel(camera, ideal) : std::optional(ideal);
  return px && px->x() >= 0 && px->x() < camera.width_px && px->y() >= 0 &&
         px->y() < camera.height_px;
}

float inverse_depth_gate(double inverse_depth) {
  return static_cast<float>(0.05 + 0.15 * inverse_depth);
}

std::optional<Projection> project_landmark(const CameraModel& camera,
                                           const std::vector<float>& level_scales,
                                           const Eigen::Isometry3d& T_camera_world,
                                           const Landmark& landmark,
                                           double radius_px) {
  constexpr double kMinViewingCosine = 0.5;
  constexpr double kHeadOnCosine = 0.998;
  const Eigen::Vector3d p_camera = T_camera_world * landmark.p_world;
  if (!in_view(camera, p_camera)) return std::nullopt;
  const double distance = p_camera.norm();
  if (distance < 0.8 * landmark.min_distance_m || distance > 1.2 * landmark.max_distance_m) {
    return std::nullopt;
  }
  const Eigen::Vector3d direction_camera = T_camera_world.linear() * landmark.viewing_direction;
  const double cosine = direction_camera.dot(p_camera) / distance;
  if (cosine < kMinViewingCosine) return std::nullopt;

  const int level = predict_level(level_scales, landmark.max_distance_m, distance);
  const double scale = static_cast<double>(level_scales[static_cast<std::size_t>(level)]);
  Projection projection;
  projection.px = camera.project(p_camera).cast<float>();
  projection.radius_px =
      static_cast<float>(radius_px * scale * (cosine > kHeadOnCosine ? 0.625 : 1.0));
  projection.inverse_depth = static_cast<float>(1.0 / p_camera.z());
  projection.max_inverse_depth_error = inverse_depth_gate(1.0 / p_camera.z());
  projection.min_level = level - 1;
  projection.max_level = level + 1;
  projection.descriptor = &landmark.descriptor;
  return projection;
}

}  // namespace stillmap
