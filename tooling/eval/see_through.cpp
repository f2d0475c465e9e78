// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/see_through.hpp"

#include <cmath>
#include <limits>
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

// Up to the largest number of its type: a long recording looks more often.
void count_up(std::uint16_t& times) {
  if (times < std::numeric_limits<std::uint16_t>::max()) ++times;
}

}  // namespace

SeeThroughTest::SeeThroughTest(const CameraModel& camera, std::vector<Eigen::Vector3f> points_world)
    : camera_(camera),
      ideal_image_px_(ideal_image(camera)),
      points_(std::move(points_world)),
      looks_(points_.size()) {}

void SeeThroughTest::look(const DepthImage& depth,
                          const Eigen::Vector3d& p_camera,
                          Looks& looks) const {
  const Eigen::Vector2d ideal_px = camera_.project(p_camera);
  if (!ideal_image_px_.contains(ideal_px)) return;
  const Eigen::Vector2d raw_px = camera_.distorted() ? camera_.distort(ideal_px) : ideal_px;
  const double column = std::floor(raw_px.x() + 0.5);
  const double row = std::floor(raw_px.y() + 0.5);
  const bool inside = column >= 0 && row >= 0 && column < depth.mat.cols && row < depth.mat.rows;
  if (!inside) return;
  const double z = static_cast<double>(depth.mat(static_cast<int>(row), static_cast<int>(column)));
  if (!(z > 0)) return;
  const double behind_m = z - p_camera.z();
  const double margin_m = kSeeThroughMargin_m + kSeeThroughSigmas * kDepthSigma * z * z;
  if (std::abs(behind_m) <= margin_m) count_up(looks.at);
  if (behind_m > margin_m) count_up(looks.through);
}

void SeeThroughTest::add(const DepthImage& depth, const Eigen::Isometry3d& T_world_camera) {
  STILLMAP_CHECK(depth.mat.cols == camera_.width_px && depth.mat.rows == camera_.height_px);
  ++frames_;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d p_camera = T_camera_world * points_[i].cast<double>();
    if (p_camera.z() > 0) look(depth, p_camera, looks_[i]);
  }
}

Residue SeeThroughTest::result() const {
  Residue residue{.points = points_.size(), .frames = frames_};
  for (const Looks& looks : looks_) {
    if (looks.through < kSeeThroughFrames) continue;
    ++residue.seen_through;
    if (looks.through <= looks.at) ++residue.by_noise;
  }
  return residue;
}

}  // namespace stillmap
