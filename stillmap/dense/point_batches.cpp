// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/point_batches.hpp"

#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

/// Of the rays through the corners of the image and the middles of its sides.
double greatest_slope_squared(const CameraModel& camera) {
  double greatest = 0;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      const Eigen::Vector2d raw((camera.width_px - 1) * x, (camera.height_px - 1) * y);
      const Eigen::Vector2d ideal = camera.undistort(raw);
      // Beyond a fold there are no rays. A fish-eye that sees all in front of it has no bound.
      if (camera.lens != LensModel::kFisheye && !camera.has_ray(ideal)) continue;
      greatest = std::max(greatest, camera.unproject(ideal, 1.0).head<2>().squaredNorm());
    }
  }
  return greatest;
}

}  // namespace

PointBatch::PointBatch(std::span<const Eigen::Vector3f> points) {
  STILLMAP_CHECK(points.size() <= kSize);
  Eigen::AlignedBox3f box;
  for (std::size_t n = 0; n < points.size(); ++n) {
    x[n] = points[n].x();
    y[n] = points[n].y();
    z[n] = points[n].z();
    box.extend(points[n]);
  }
  center = box.center();
  radius = 0.5F * box.diagonal().norm() * 1.001F;
}

BatchProjector::BatchProjector(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world)
    : T_(T_camera_world.matrix().topRows<3>().cast<float>()),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx + 0.5)),
      cy_(static_cast<float>(camera.cy + 0.5)),
      lens_(BrownConradyLens<float>(camera)),
      max_r2_(static_cast<float>(1.1 * greatest_slope_squared(camera))) {
  if (camera.lens == LensModel::kFisheye) lens_ = FisheyeLens<float>(camera);
}

bool BatchProjector::misses(const PointBatch& batch) const {
  const Eigen::Vector3f p = T_.leftCols<3>() * batch.center + T_.col(3);
  // The distance of the centre from the cone around the optical axis that contains the image.
  const float outside = p.head<2>().norm() - std::sqrt(max_r2_) * p.z();
  return outside > batch.radius * std::sqrt(1.0F + max_r2_) ||
         p.z() < kNearestDepth_m - batch.radius;
}

void BatchProjector::project(const PointBatch& batch, ProjectedBatch& out) const {
  std::visit([&](const auto& lens) { project_with(lens, batch, out); }, lens_);
}

template <class SomeLens>
void BatchProjector::project_with(const SomeLens lens,
                                  const PointBatch& batch,
                                  ProjectedBatch& out) const {
  const float a = T_(0, 0), b = T_(0, 1), c = T_(0, 2), d = T_(0, 3);
  const float e = T_(1, 0), f = T_(1, 1), g = T_(1, 2), h = T_(1, 3);
  const float i = T_(2, 0), j = T_(2, 1), k = T_(2, 2), l = T_(2, 3);
  for (std::size_t n = 0; n < PointBatch::kSize; ++n) {  // branch-free, so that it vectorises
    const float px = batch.x[n], py = batch.y[n], pz = batch.z[n];
    const float z = i * px + j * py + k * pz + l;
    const float inverse_z = 1.0F / std::max(z, kNearestDepth_m);
    const float x = (a * px + b * py + c * pz + d) * inverse_z;
    const float y = (e * px + f * py + g * pz + h) * inverse_z;
    const float r2 = x * x + y * y;
    const LensPoint<float> at = lens(x, y);
    // Far outside the image the distortion polynomial is meaningless and may lead back into the
    // image.
    const float far = r2 < max_r2_ ? 0.0F : -1e6F;
    out.u[n] = fx_ * at.x + cx_ + far;
    out.v[n] = fy_ * at.y + cy_;
    out.z[n] = z;
  }
}

}  // namespace stillmap
