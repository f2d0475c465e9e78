// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/see_through.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Beyond this bound the distortion polynomial may bend rays back into the image.
Eigen::AlignedBox2d ideal_image(const CameraModel& camera) {
  Eigen::AlignedBox2d box;
  const double right = camera.width_px - 0.5;
  const double bottom = camera.height_px - 0.5;
  for (int i = 0; i <= 32; ++i) {  // along all four edges
    const double x = -0.5 + (right + 0.5) * i / 32;
    const double y = -0.5 + (bottom + 0.5) * i / 32;
    for (const Eigen::Vector2d& raw_px : {Eigen::Vector2d(x, -0.5),
                                          Eigen::Vector2d(x, bottom),
                                          Eigen::Vector2d(-0.5, y),
                                          Eigen::Vector2d(right, y)}) {
      const Eigen::Vector2d ideal_px = camera.undistort(raw_px);
      // Beyond a fold there are no rays; a fish-eye may see all that is in front of it.
      if (camera.lens == LensModel::kFisheye || camera.has_ray(ideal_px)) box.extend(ideal_px);
    }
  }
  return box;
}

}  // namespace

SeeThroughTest::SeeThroughTest(const CameraModel& camera, std::vector<Eigen::Vector3f> points_world)
    : camera_(camera),
      ideal_image_px_(ideal_image(camera)),
      points_(std::move(points_world)),
      times_(points_.size(), 0) {}

bool SeeThroughTest::sees_through(const DepthImage& depth, const Eigen::Vector3d& p_camera) const {
  const Eigen::Vector2d ideal_px = camera_.project(p_camera);
  if (!ideal_image_px_.contains(ideal_px)) return false;
  const Eigen::Vector2d raw_px = camera_.distorted() ? camera_.distort(ideal_px) : ideal_px;
  const double column = std::floor(raw_px.x() + 0.5);
  const double row = std::floor(raw_px.y() + 0.5);
  const bool inside = column >= 0 && row >= 0 && column < depth.mat.cols && row < depth.mat.rows;
  if (!inside) return false;
  const double z = static_cast<double>(depth.mat(static_cast<int>(row), static_cast<int>(column)));
  if (!(z > p_camera.z())) return false;
  return z - p_camera.z() > kSeeThroughMargin_m + kSeeThroughSigmas * kDepthSigma * z * z;
}

void SeeThroughTest::add(const DepthImage& depth, const Eigen::Isometry3d& T_world_camera) {
  STILLMAP_CHECK(depth.mat.cols == camera_.width_px && depth.mat.rows == camera_.height_px);
  ++frames_;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (times_[i] >= kSeeThroughFrames) continue;
    const Eigen::Vector3d p_camera = T_camera_world * points_[i].cast<double>();
    if (p_camera.z() > 0 && sees_through(depth, p_camera)) ++times_[i];
  }
}

Residue SeeThroughTest::result() const {
  const auto seen =
      std::ranges::count_if(times_, [](std::uint8_t times) { return times >= kSeeThroughFrames; });
  return {
      .points = points_.size(), .seen_through = static_cast<std::size_t>(seen), .frames = frames_};
}

}  // namespace stillmap
