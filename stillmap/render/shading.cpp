// SPDX-License-Identifier: Apache-2.0
#include "stillmap/render/shading.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {
namespace {

using Moment = MovingCamera::Moment;

Moment moment_at(const Exposure& exposure, double time) {
  const Eigen::Quaterniond open(exposure.T_world_camera_open.linear());
  const Eigen::Quaterniond close(exposure.T_world_camera_close.linear());
  const Eigen::Vector3d origin = (1 - time) * exposure.T_world_camera_open.translation() +
                                 time * exposure.T_world_camera_close.translation();
  return {open.slerp(time, close).toRotationMatrix().cast<float>(),
          origin.cast<float>(),
          static_cast<float>(time)};
}

// A triangle's plane at one time, ready to be met by rays.
struct TrianglePlane {
  Eigen::Vector3f corner, edge_u, edge_v, normal;
  Eigen::Vector3f dual_u, dual_v;  // their products with a point's offset are its coordinates

  TrianglePlane(const SurfaceTriangle& t, float time) {
    const auto at = [&](std::size_t k) {
      return t.moves ? Eigen::Vector3f((1 - time) * t.open[k] + time * t.close[k]) : t.open[k];
    };
    corner = at(0);
    edge_u = at(1) - corner;
    edge_v = at(2) - corner;
    normal = edge_u.cross(edge_v);
    const float scale = 1.F / std::max(normal.squaredNorm(), 1e-30F);
    dual_u = scale * edge_v.cross(normal);
    dual_v = scale * normal.cross(edge_u);
  }

  [[nodiscard]] Eigen::Vector2f coordinates(const Eigen::Vector3f& step) const {
    return {dual_u.dot(step), dual_v.dot(step)};
  }
};

// Where a ray meets a triangle's plane; not held to the triangle.
struct PlaneMeeting {
  Eigen::Vector3f direction;
  float inverse_along;  // 1 / (normal . direction)
  float t;
  Eigen::Vector2f at;  // barycentric

  PlaneMeeting(const TrianglePlane& plane,
               const Eigen::Vector3f& origin,
               const Eigen::Vector3f& ray_direction)
      : direction(ray_direction) {
    const Eigen::Vector3f offset = origin - plane.corner;
    const float along = plane.normal.dot(direction);
    inverse_along = 1.F / (std::abs(along) > 1e-20F ? along : 1e-20F);
    t = -plane.normal.dot(offset) * inverse_along;
    at = plane.coordinates(offset + t * direction);
  }

  // How far the meeting moves on the plane, to first order, when the point that the ray had here
  // moves by `step`.
  [[nodiscard]] Eigen::Vector2f shift(const TrianglePlane& plane,
                                      const Eigen::Vector3f& step) const {
    return plane.coordinates(step - plane.normal.dot(step) * inverse_along * direction);
  }
};

Eigen::Vector2f uv_at(const SurfaceTriangle& t, const Eigen::Vector2f& b) {
  return t.uvs[0] + b.x() * (t.uvs[1] - t.uvs[0]) + b.y() * (t.uvs[2] - t.uvs[0]);
}

// Barycentric coordinates brought back onto the triangle's neighbourhood: far outside, at a
// silhouette, an extrapolated normal means nothing.
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
float longest_step_level(const MipTexture& texture, const std::array<Eigen::Vector2f, 3>& steps) {
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

// What a pixel covers of a triangle's plane half way through the exposure: its middle on the
// picture, the steps from one quarter to the next, and how far the picture moves.
struct Footprint {
  TrianglePlane plane;
  PlaneMeeting middle;
  Eigen::Vector2f across, down;
  Eigen::Vector2f motion = Eigen::Vector2f::Zero();

  Footprint(const SurfaceTriangle& triangle, const MovingCamera& camera, const PixelRays& rays)
      : plane(triangle, 0.5F),
        middle(plane, camera.middle.origin, camera.middle.R_world_camera * rays.center) {
    const Eigen::Matrix3f& R = camera.middle.R_world_camera;
    const auto step_to = [&](const Eigen::Vector3f& camera_step) {
      return uv_step(triangle, middle.shift(plane, middle.t * (R * camera_step)));
    };
    across = step_to(rays.quarters[1] - rays.quarters[0]);
    down = step_to(rays.quarters[2] - rays.quarters[0]);
    if (!camera.moves && !triangle.moves) return;
    Eigen::Vector3f step = Eigen::Vector3f::Zero();
    if (camera.moves) step = camera.translation + middle.t * (camera.turn * rays.center);
    if (triangle.moves) step -= surface_motion(triangle, middle.at);
    motion = uv_step(triangle, middle.shift(plane, step));
  }

  [[nodiscard]] float mip_level(const MipTexture& texture) const {
    return longest_step_level(texture, {across, down, 0.25F * motion});
  }
};

}  // namespace

MovingCamera::MovingCamera(const Exposure& exposure)
    : open(moment_at(exposure, 0.0)),
      middle{exposure.T_world_camera.linear().cast<float>(),
             exposure.T_world_camera.translation().cast<float>(),
             0.5F},
      close(moment_at(exposure, 1.0)),
      translation(close.origin - open.origin),
      turn(close.R_world_camera - open.R_world_camera),
      moves(exposure.T_world_camera_open.matrix() != exposure.T_world_camera_close.matrix()) {
  // Not in the order of the quarters, so that motion along neither axis meets a pattern.
  constexpr std::array<double, 4> kTimes{0.375, 0.875, 0.125, 0.625};
  for (std::size_t k = 0; k < 4; ++k) {
    quarters[k] = moves ? moment_at(exposure, kTimes[k]) : middle;
    quarters[k].time = static_cast<float>(kTimes[k]);
  }
}

SurfacePatch plain_patch(const SurfaceTriangle& triangle,
                         const Material& material,
                         const MovingCamera& camera,
                         const PixelRays& rays) {
  const Footprint footprint(triangle, camera, rays);
  const Eigen::Vector2f center = uv_at(triangle, footprint.middle.at);
  std::array<TexturePoint, 4> at;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2f uv = center + (k % 2 == 0 ? -0.5F : 0.5F) * footprint.across +
                               (k < 2 ? -0.5F : 0.5F) * footprint.down +
                               (camera.quarters[k].time - 0.5F) * footprint.motion;
    at[k] = {uv.x(), uv.y()};
  }
  const TexelSum sum =
      material.texture.sample_four(at, footprint.mip_level(material.texture), material.repeats);
  return {to_color(sum, 1.F / (4.F * 256.F)),
          point_at(footprint.plane, footprint.middle.at),
          normal_at(triangle, footprint.middle.at, footprint.middle.direction)};
}

SurfacePatch quarter_patch(const SurfaceTriangle& triangle,
                           const Material& material,
                           const MovingCamera& camera,
                           const PixelRays& rays,
                           std::size_t quarter) {
  const Footprint footprint(triangle, camera, rays);
  const Moment& moment = camera.quarters[quarter];
  const TrianglePlane plane(triangle, moment.time);
  const PlaneMeeting meeting(plane, moment.origin, moment.R_world_camera * rays.quarters[quarter]);
  const Eigen::Vector2f uv = uv_at(triangle, meeting.at);
  const TexelSum texel = material.texture.sample(
      {uv.x(), uv.y()}, footprint.mip_level(material.texture), material.repeats);
  return {to_color(texel, 1.F / 256.F),
          point_at(plane, meeting.at),
          normal_at(triangle, meeting.at, meeting.direction)};
}

Eigen::Vector3f lit(const Eigen::Vector3f& albedo, const Material& material, float light) {
  // Colours are as a screen shows them, about the square root of light.
  return albedo * std::sqrt(std::max(light, material.glow));
}

}  // namespace stillmap
