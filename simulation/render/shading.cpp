// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/shading.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {
namespace {

using Moment = MovingCamera::Moment;

Moment moment_at(const CameraExposure& exposure, double time) {
  const Eigen::Quaterniond open(exposure.T_world_camera_open.linear());
  const Eigen::Quaterniond close(exposure.T_world_camera_close.linear());
  const Eigen::Vector3d origin = (1 - time) * exposure.T_world_camera_open.translation() +
                                 time * exposure.T_world_camera_close.translation();
  return {open.slerp(time, close).toRotationMatrix().cast<float>(),
          origin.cast<float>(),
          static_cast<float>(time)};
}

Eigen::Vector2f uv_at(const SurfaceTriangle& t, const Eigen::Vector2f& b) {
  return t.uvs[0] + b.x() * (t.uvs[1] - t.uvs[0]) + b.y() * (t.uvs[2] - t.uvs[0]);
}

// Barycentric coordinates clamped to the triangle's neighbourhood: far outside, at a silhouette, an
// extrapolated normal is meaningless.
Eigen::Vector3f normal_at(const SurfaceTriangle& t,
                          const Eigen::Vector2f& b,
                          const Eigen::Vector3f& direction) {
  const Eigen::Vector2f inside = b.cwiseMax(0.F).cwiseMin(1.F);
  const Eigen::Vector3f normal = (1 - inside.x() - inside.y()) * t.normals[0] +
                                 inside.x() * t.normals[1] + inside.y() * t.normals[2];
  const Eigen::Vector3f unit = normal.normalized();
  return unit.dot(direction) > 0 ? Eigen::Vector3f(-unit) : unit;
}

Eigen::Vector3f point_at(const TrianglePlane& plane, const Eigen::Vector2f& b) {
  return plane.corner + b.x() * plane.edge_u + b.y() * plane.edge_v;
}

// The pyramid's level whose texels are as wide as the longest of some steps on the picture.
float mip_level(const MipTexture& texture, const std::array<Eigen::Vector2f, 3>& steps) {
  const Eigen::Vector2f size(static_cast<float>(texture.width()),
                             static_cast<float>(texture.height()));
  float longest = 0.F;
  for (const Eigen::Vector2f& step : steps) {
    longest = std::max(longest, step.cwiseProduct(size).squaredNorm());
  }
  return 0.5F * std::log2(std::max(longest, 1e-12F));
}

Eigen::Vector3f to_color(const TexelSum& sum, float scale) {
  return scale * Eigen::Vector3f(static_cast<float>(sum[0]),
                                 static_cast<float>(sum[1]),
                                 static_cast<float>(sum[2]));
}

Eigen::Vector2f uv_step(const SurfaceTriangle& t, const Eigen::Vector2f& b) {
  return b.x() * (t.uvs[1] - t.uvs[0]) + b.y() * (t.uvs[2] - t.uvs[0]);
}

// How far the point with barycentric coordinates `b` moves while the shutter is open.
Eigen::Vector3f surface_motion(const SurfaceTriangle& t, const Eigen::Vector2f& b) {
  return (1 - b.x() - b.y()) * (t.close[0] - t.open[0]) + b.x() * (t.close[1] - t.open[1]) +
         b.y() * (t.close[2] - t.open[2]);
}

}  // namespace

MovingCamera::MovingCamera(const CameraExposure& exposure)
    : middle{exposure.T_world_camera.linear().cast<float>(),
             exposure.T_world_camera.translation().cast<float>(),
             0.5F},
      moves(exposure.T_world_camera_open.matrix() != exposure.T_world_camera_close.matrix()) {
  const Moment open = moment_at(exposure, 0.0), close = moment_at(exposure, 1.0);
  translation = close.origin - open.origin;
  turn = close.R_world_camera - open.R_world_camera;
  for (std::size_t k = 0; k < 4; ++k) {
    const float time = kMoments[kQuarterMoments[k]];
    quarters[k] = moves ? moment_at(exposure, time) : middle;
    quarters[k].time = time;
  }
}

PixelSurface::PixelSurface(const SurfaceTriangle& triangle,
                           const Material& material,
                           const MovingCamera& camera,
                           const PixelRays& rays)
    : triangle_(&triangle),
      material_(&material),
      camera_(&camera),
      rays_(&rays),
      plane_(triangle, kMoments[kMiddle]),
      middle_(plane_, camera.middle.origin, camera.middle.R_world_camera * rays.center) {
  const Eigen::Matrix3f& R = camera.middle.R_world_camera;
  const auto step_to = [&](const Eigen::Vector3f& camera_step) {
    return uv_step(triangle, middle_.shift(plane_, middle_.t * (R * camera_step)));
  };
  across_ = step_to(rays.quarters[1] - rays.quarters[0]);
  down_ = step_to(rays.quarters[2] - rays.quarters[0]);
  if (camera.moves || triangle.moves) {
    Eigen::Vector3f step = Eigen::Vector3f::Zero();
    if (camera.moves) step = camera.translation + middle_.t * (camera.turn * rays.center);
    if (triangle.moves) step -= surface_motion(triangle, middle_.at);
    motion_ = uv_step(triangle, middle_.shift(plane_, step));
  }
  level_ = mip_level(material.texture, {across_, down_, 0.25F * motion_});
}

SurfacePatch PixelSurface::whole() const {
  const Eigen::Vector2f center = uv_at(*triangle_, middle_.at);
  std::array<TexturePoint, 4> at;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2f uv = center + (k % 2 == 0 ? -0.5F : 0.5F) * across_ +
                               (k < 2 ? -0.5F : 0.5F) * down_ +
                               (camera_->quarters[k].time - 0.5F) * motion_;
    at[k] = {uv.x(), uv.y()};
  }
  const TexelSum sum = material_->texture.sample_four(at, level_, material_->repeats);
  return {to_color(sum, 1.F / (4.F * 256.F)),
          point_at(plane_, middle_.at),
          normal_at(*triangle_, middle_.at, middle_.direction)};
}

SurfacePatch PixelSurface::center() const {
  return patch_at(plane_, middle_);
}

SurfacePatch PixelSurface::quarter(std::size_t k) const {
  const Moment& moment = camera_->quarters[k];
  const TrianglePlane plane = triangle_->moves ? TrianglePlane(*triangle_, moment.time) : plane_;
  return patch_at(plane,
                  PlaneMeeting(plane, moment.origin, moment.R_world_camera * rays_->quarters[k]));
}

SurfacePatch PixelSurface::patch_at(const TrianglePlane& plane, const PlaneMeeting& meeting) const {
  const Eigen::Vector2f uv = uv_at(*triangle_, meeting.at);
  const TexelSum texel = material_->texture.sample({uv.x(), uv.y()}, level_, material_->repeats);
  return {to_color(texel, 1.F / 256.F),
          point_at(plane, meeting.at),
          normal_at(*triangle_, meeting.at, meeting.direction)};
}

Eigen::Vector3f lit(const Eigen::Vector3f& albedo, const Material& material, float light) {
  // Colours are those of a screen: about the square root of light.
  return albedo * std::sqrt(std::max(light, material.glow));
}

}  // namespace stillmap
