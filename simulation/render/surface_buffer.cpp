// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/surface_buffer.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {
namespace {

// The normal in the middle of the exposure, on the side that the ray comes from.
Eigen::Vector3f facing_normal(const SurfaceTriangle& t, const Eigen::Vector3f& direction) {
  const Eigen::Vector3f a = t.open[0] + t.close[0], b = t.open[1] + t.close[1],
                        c = t.open[2] + t.close[2];
  const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
  return normal.dot(direction) > 0 ? Eigen::Vector3f(-normal) : normal;
}

Surfel surfel_at(const RayScene& scene, const Ray& ray, const SurfaceHit& hit) {
  Surfel surfel;
  surfel.hit = hit;
  if (!hit.valid()) return surfel;
  const SurfaceTriangle triangle = scene.triangle(hit);
  surfel.material = triangle.material;
  surfel.point = ray.origin + hit.t * ray.direction;
  surfel.normal = facing_normal(triangle, ray.direction);
  return surfel;
}

// How far the image of a surface moves while the shutter is open.
float motion_px(const Surfel& surfel,
                const RayScene& scene,
                const CameraExposure& exposure,
                float focal_length_px) {
  if (!surfel.hit.valid()) return 0.F;
  const SurfaceTriangle t = scene.triangle(surfel.hit);
  const Eigen::Vector3f step =
      (t.close[0] + t.close[1] + t.close[2] - t.open[0] - t.open[1] - t.open[2]) / 6.F;
  const auto image_of = [&](const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3f& p) {
    const Eigen::Vector3d camera = T_world_camera.inverse() * p.cast<double>();
    return Eigen::Vector2d(camera.head<2>() / std::max(camera.z(), 0.05));
  };
  const Eigen::Vector2d moved = image_of(exposure.T_world_camera_close, surfel.point + step) -
                                image_of(exposure.T_world_camera_open, surfel.point - step);
  return focal_length_px * static_cast<float>(moved.norm());
}

}  // namespace

bool continuous(const Surfel& a, const Surfel& b) {
  if (a.hit.object != b.hit.object || a.material != b.material) return false;
  if (!a.hit.valid()) return true;
  constexpr float kSameDirection = 0.6F;  // cosine
  if (a.normal.dot(b.normal) < kSameDirection) return false;
  // The bend of the normals must explain the distance from the other's tangent plane.
  const Eigen::Vector3f step = b.point - a.point;
  const float off = std::max(std::abs(a.normal.dot(step)), std::abs(b.normal.dot(step)));
  return off < 0.002F + 0.4F * step.norm();
}

SurfaceBuffer trace_surfaces(const RayScene& scene,
                             const Exposure& exposure,
                             const cv::Mat2f& rays) {
  SurfaceBuffer buffer{rays.cols, rays.rows, std::vector<Surfel>(rays.total())};
  constexpr int kAcross = 4, kDown = 2;  // a packet of rays that lie close together
  static_assert(kAcross * kDown == kRays);
  for (int y = 0; y < rays.rows; y += kDown) {
    for (int x = 0; x < rays.cols; x += kAcross) {
      std::array<Ray, kRays> packet;
      std::array<Surfel*, kRays> targets{};
      std::size_t count = 0;
      for (int v = y; v < std::min(y + kDown, rays.rows); ++v) {
        const Eigen::Isometry3d& T_world_camera = exposure.of_row(v).T_world_camera;
        const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
        const Eigen::Vector3f origin = T_world_camera.translation().cast<float>();
        for (int u = x; u < std::min(x + kAcross, rays.cols); ++u) {
          const cv::Vec2f& xy = rays(v, u);
          packet[count].origin = origin;
          packet[count].direction = R * Eigen::Vector3f(xy[0], xy[1], 1.F);
          targets[count++] = &buffer.surfels[static_cast<std::size_t>(v * rays.cols + u)];
        }
      }
      const std::array<SurfaceHit, kRays> hits = scene.first_hits({packet.data(), count});
      for (std::size_t i = 0; i < count; ++i) *targets[i] = surfel_at(scene, packet[i], hits[i]);
    }
  }
  return buffer;
}

cv::Mat1b mixed_pixels(const SurfaceBuffer& surfaces,
                       const RayScene& scene,
                       const Exposure& exposure,
                       float focal_length_px) {
  constexpr float kFarthest = 6.F;  // pixels
  cv::Mat1b mixed(surfaces.height, surfaces.width, std::uint8_t{0});
  const auto mark_edge = [&](int x, int y, int nx, int ny) {
    const Surfel& here = surfaces.at(x, y);
    const Surfel& there = surfaces.at(nx, ny);
    if (continuous(here, there)) return;
    const CameraExposure& row = exposure.of_row(y);
    const float motion = std::max(motion_px(here, scene, row, focal_length_px),
                                  motion_px(there, scene, row, focal_length_px));
    // The edge lies between the two centres and sweeps half of the motion to either side.
    const int reach =
        static_cast<int>(std::max(0.F, std::ceil(0.5F * std::min(motion, kFarthest) - 0.5F)));
    const int left = std::max(x - reach, 0), right = std::min(nx + reach, mixed.cols - 1);
    const int bottom = std::min(ny + reach, mixed.rows - 1);
    for (int v = std::max(y - reach, 0); v <= bottom; ++v) {
      std::fill(mixed.ptr(v) + left, mixed.ptr(v) + right + 1, std::uint8_t{255});
    }
  };
  for (int y = 0; y < surfaces.height; ++y) {
    for (int x = 0; x < surfaces.width; ++x) {
      if (x + 1 < surfaces.width) mark_edge(x, y, x + 1, y);
      if (y + 1 < surfaces.height) mark_edge(x, y, x, y + 1);
    }
  }
  return mixed;
}

}  // namespace stillmap
