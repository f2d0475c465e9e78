// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/renderer.hpp"

#include <algorithm>
#include <thread>

#include "stillmap/core/error.hpp"
#include "stillmap/synth/frame_view.hpp"

namespace stillmap {
namespace {

constexpr int kTileSize = 16;

// The same camera with every pixel cut into four.
CameraModel with_quartered_pixels(CameraModel camera) {
  camera.width_px *= 2;
  camera.height_px *= 2;
  camera.fx *= 2;
  camera.fy *= 2;
  camera.cx = 2 * camera.cx + 0.5;
  camera.cy = 2 * camera.cy + 0.5;
  return camera;
}

Eigen::Vector3d ray_of(const cv::Vec2f& xy) {
  return {xy[0], xy[1], 1.0};
}

SubRays sub_rays_at(const cv::Mat2f& sub_rays, int x, int y) {
  const cv::Vec2f* upper = sub_rays.ptr<cv::Vec2f>(2 * y) + 2 * x;
  const cv::Vec2f* lower = sub_rays.ptr<cv::Vec2f>(2 * y + 1) + 2 * x;
  return {ray_of(upper[0]), ray_of(upper[1]), ray_of(lower[0]), ray_of(lower[1])};
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.F, 255.F));
}

// Whether a pixel and its eight neighbours lie on one surface; `x` and `y` are not on the border.
bool plain_around(const cv::Mat1i& surfaces, int x, int y) {
  const int id = surfaces(y, x);
  for (int row = y - 1; row <= y + 1; ++row) {
    const int* s = surfaces.ptr<int>(row) + x;
    if (s[-1] != id || s[0] != id || s[1] != id) return false;
  }
  return id != 0;
}

// Runs work(0..count-1), dealt to the threads in contiguous runs.
template <class Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
  const std::size_t workers = static_cast<std::size_t>(std::max(threads, 1));
  const auto run = [&](std::size_t worker) {
    for (std::size_t i = count * worker / workers; i < count * (worker + 1) / workers; ++i) work(i);
  };
  std::vector<std::jthread> pool;
  for (std::size_t worker = 1; worker < workers; ++worker) pool.emplace_back(run, worker);
  run(0);
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const Scene> scene, const CameraModel& camera)
    : scene_(std::move(scene)),
      rays_(pixel_rays(camera)),
      sub_rays_(pixel_rays(with_quartered_pixels(camera))) {
  STILLMAP_CHECK(scene_ != nullptr);
  const cv::Rect image(0, 0, rays_.cols, rays_.rows);
  for (int y = 0; y < rays_.rows; y += kTileSize) {
    for (int x = 0; x < rays_.cols; x += kTileSize) {
      tiles_.push_back(make_tile(cv::Rect(x, y, kTileSize, kTileSize) & image));
    }
  }
}

Renderer::Tile Renderer::make_tile(const cv::Rect& pixels) const {
  const cv::Rect quarters(2 * pixels.x, 2 * pixels.y, 2 * pixels.width, 2 * pixels.height);
  Tile tile{pixels, Eigen::Vector2d::Constant(1e9), Eigen::Vector2d::Constant(-1e9)};
  // A pixel's centre lies between its quarters; the margin covers what rounding might add.
  constexpr double kMargin = 1e-5;
  for (const cv::Vec2f& ray : sub_rays_(quarters)) {
    const Eigen::Vector2d xy(ray[0], ray[1]);
    tile.min = tile.min.cwiseMin((xy.array() - kMargin).matrix());
    tile.max = tile.max.cwiseMax((xy.array() + kMargin).matrix());
  }
  return tile;
}

RenderedImage Renderer::render(const Eigen::Isometry3d& T_world_camera, int threads) const {
  const FrameView view(*scene_, T_world_camera);
  RenderedImage image{ColorImage(cv::Mat3b(rays_.size())), DepthImage(cv::Mat1f(rays_.size()))};
  cv::Mat1i surfaces(rays_.size());
  std::vector<std::vector<std::uint32_t>> candidates(tiles_.size());

  for_each_index(tiles_.size(), threads, [&](std::size_t i) {
    const cv::Rect& r = tiles_[i].pixels;
    candidates[i] = view.boxes_within(tiles_[i].min, tiles_[i].max);
    for (int y = r.y; y < r.y + r.height; ++y) {
      for (int x = r.x; x < r.x + r.width; ++x) {
        const ViewHit hit = view.nearest(ray_of(rays_(y, x)), candidates[i]);
        surfaces(y, x) = hit.surface.value;
        image.depth.mat(y, x) = static_cast<float>(hit.depth);
      }
    }
  });

  // Colour needs the neighbours' surfaces, so it comes after all of them are known.
  const cv::Rect inner(1, 1, rays_.cols - 2, rays_.rows - 2);
  for_each_index(tiles_.size(), threads, [&](std::size_t i) {
    const cv::Rect& r = tiles_[i].pixels;
    for (int y = r.y; y < r.y + r.height; ++y) {
      for (int x = r.x; x < r.x + r.width; ++x) {
        const SubRays rays = sub_rays_at(sub_rays_, x, y);
        const bool plain = inner.contains(cv::Point(x, y)) && plain_around(surfaces, x, y);
        const Eigen::Vector3f color = plain ? view.shade_plain(SurfaceId{surfaces(y, x)}, rays)
                                            : view.shade_mixed(rays, candidates[i]);
        image.color.mat(y, x) = {to_byte(color[0]), to_byte(color[1]), to_byte(color[2])};
      }
    }
  });
  return image;
}

}  // namespace stillmap
