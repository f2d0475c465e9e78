// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/frame_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stillmap/synth/slab.hpp"

namespace stillmap {
namespace {

Eigen::Vector3f to_color(const TexelSum& sum, float scale) {
  return scale * Eigen::Vector3f(static_cast<float>(sum[0]),
                                 static_cast<float>(sum[1]),
                                 static_cast<float>(sum[2]));
}

// The pyramid's level whose texels are as wide as the step from one ray to the next, in the wider
// of both directions so that nothing aliases.
float mip_level(const MipTexture& texture, const std::array<TexturePoint, 4>& at) {
  const float width = static_cast<float>(texture.width());
  const float height = static_cast<float>(texture.height());
  const auto squared_texels = [&](const TexturePoint& p) {
    const float x = (p.u - at[0].u) * width, y = (p.v - at[0].v) * height;
    return x * x + y * y;
  };
  return 0.5F * std::log2(std::max(squared_texels(at[1]), squared_texels(at[2])));
}

// Whether all corners lie on the far side of a plane through the camera's centre.
bool all_beyond(const std::array<Eigen::Vector3d, 8>& corners, const Eigen::Vector3d& normal) {
  return std::all_of(
      corners.begin(), corners.end(), [&](const Eigen::Vector3d& p) { return normal.dot(p) > 0; });
}

}  // namespace

FrameView::FrameView(const Scene& scene, const Eigen::Isometry3d& T_world_camera) : scene_(&scene) {
  boxes_.reserve(scene.boxes.size());
  for (const SceneBox& box : scene.boxes) {
    const Eigen::Isometry3d T_box_world = box.T_world_box.inverse();
    const Eigen::Isometry3d T_camera_box = T_world_camera.inverse() * box.T_world_box;
    BoxView view;
    view.box = &box;
    view.R_box_camera = T_camera_box.linear().transpose();
    view.camera_in_box = T_box_world * T_world_camera.translation();
    view.lamp_in_box = T_box_world * scene.lamp_world;
    for (unsigned i = 0; i < 8; ++i) {
      const Eigen::Vector3d sign((i & 1U) ? 1 : -1, (i & 2U) ? 1 : -1, (i & 4U) ? 1 : -1);
      view.corners_camera[i] = T_camera_box * box.half_size.cwiseProduct(sign);
    }
    boxes_.push_back(view);
  }
}

std::vector<std::uint32_t> FrameView::boxes_within(const Eigen::Vector2d& min,
                                                   const Eigen::Vector2d& max) const {
  const std::array<Eigen::Vector3d, 5> outwards{
      {{1, 0, -max.x()}, {-1, 0, min.x()}, {0, 1, -max.y()}, {0, -1, min.y()}, {0, 0, -1}}};
  std::vector<std::uint32_t> inside;
  for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
    const bool outside =
        std::any_of(outwards.begin(), outwards.end(), [&](const Eigen::Vector3d& normal) {
          return all_beyond(boxes_[i].corners_camera, normal);
        });
    if (!outside) inside.push_back(i);
  }
  return inside;
}

ViewHit FrameView::nearest(const Eigen::Vector3d& ray,
                           std::span<const std::uint32_t> candidates) const {
  double depth = std::numeric_limits<double>::infinity();
  SurfaceId surface;
  for (const std::uint32_t i : candidates) {
    const BoxView& view = boxes_[i];
    const SlabHit hit = intersect_slabs(view.camera_in_box,
                                        view.R_box_camera * ray,
                                        view.box->half_size,
                                        view.box->seen_from_inside);
    if (hit.t < depth) {
      depth = hit.t;
      surface.value = static_cast<std::int32_t>(6 * i) + hit.face + 1;
    }
  }
  return surface.valid() ? ViewHit{surface, depth} : ViewHit{};
}

const MipTexture& FrameView::texture_of(SurfaceId surface) const {
  const SceneBox& box = *boxes_[surface.box()].box;
  return scene_->textures[box.textures[static_cast<std::size_t>(surface.face())]];
}

FrameView::Patch FrameView::patch_on(SurfaceId surface, const SubRays& rays) const {
  const BoxView& view = boxes_[surface.box()];
  const FaceAxes axes = face_axes(surface.face());
  const Eigen::Vector3d& half = view.box->half_size;
  const double side = surface.face() % 2 == 0 ? -1.0 : 1.0;
  const double plane = side * half[axes.normal] - view.camera_in_box[axes.normal];
  const double u_scale = 0.5 / half[axes.column], v_scale = -0.5 / half[axes.row];

  Patch patch;
  Eigen::Vector3d p;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d direction = view.R_box_camera * rays[i];
    p = view.camera_in_box + plane / direction[axes.normal] * direction;
    patch.at[i] = {static_cast<float>(0.5 + u_scale * p[axes.column]),
                   static_cast<float>(0.5 + v_scale * p[axes.row])};
  }
  patch.level = mip_level(texture_of(surface), patch.at);

  const Eigen::Vector3d to_lamp = view.lamp_in_box - p;
  const double outwards = view.box->seen_from_inside ? -side : side;
  const double cosine = outwards * to_lamp[axes.normal] / to_lamp.norm();
  const double ambient = scene_->ambient;
  patch.light = static_cast<float>(ambient + (1.0 - ambient) * std::max(0.0, cosine));
  return patch;
}

Eigen::Vector3f FrameView::shade_plain(SurfaceId surface, const SubRays& rays) const {
  const Patch patch = patch_on(surface, rays);
  const TexelSum sum = texture_of(surface).sample_four(patch.at, patch.level);
  return to_color(sum, patch.light / (4.F * 256.F));
}

Eigen::Vector3f FrameView::shade_mixed(const SubRays& rays,
                                       std::span<const std::uint32_t> candidates) const {
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  Patch patch{};
  SurfaceId patched;
  for (std::size_t i = 0; i < 4; ++i) {
    const ViewHit hit = nearest(rays[i], candidates);
    if (!hit.surface.valid()) continue;
    if (!(hit.surface == patched)) patch = patch_on(hit.surface, rays);
    patched = hit.surface;
    const TexelSum texel = texture_of(patched).sample(patch.at[i], patch.level);
    color += to_color(texel, patch.light / (4.F * 256.F));
  }
  return color;
}

}  // namespace stillmap
