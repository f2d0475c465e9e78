// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/renderer.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "simulation/render/shading.hpp"
#include "simulation/render/surface_buffer.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

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

Eigen::Vector3f ray_of(const cv::Vec2f& xy) {
  return {xy[0], xy[1], 1.F};
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.F, 255.F));
}

// The hits of rays through two opposite quarters of a pixel.
struct TracedPixel {
  cv::Point at;
  std::array<std::size_t, 2> quarters{0, 3};
  std::array<SurfaceHit, 2> hits;
};

// The camera while each row is exposed.
class RowCameras {
 public:
  explicit RowCameras(const Exposure& exposure) {
    if (exposure.rows.empty()) cameras_.emplace_back(exposure);
    for (const CameraExposure& row : exposure.rows) cameras_.emplace_back(row);
  }
  [[nodiscard]] const MovingCamera& of_row(int y) const {
    return cameras_.size() == 1 ? cameras_.front() : cameras_[static_cast<std::size_t>(y)];
  }

 private:
  std::vector<MovingCamera> cameras_;
};

// The data for colouring the pixels of one image.
class Painter {
 public:
  Painter(const World& world,
          const RayScene& scene,
          const SurfaceBuffer& surfaces,
          const Lighting& lighting,
          const RowCameras& cameras)
      : world_(&world),
        scene_(&scene),
        surfaces_(&surfaces),
        lighting_(&lighting),
        cameras_(&cameras) {}

  // A pixel that shows one smooth surface.
  [[nodiscard]] Eigen::Vector3f plain(int x, int y, const PixelRays& rays) const {
    const Surfel& surfel = surfaces_->at(x, y);
    if (!surfel.hit.valid()) return Eigen::Vector3f::Zero();
    const SurfaceTriangle triangle = scene_->triangle(surfel.hit);
    const Material& material = world_->materials[triangle.material];
    const MovingCamera& camera = cameras_->of_row(y);
    const SurfacePatch patch = PixelSurface(triangle, material, camera, rays).whole();
    return in_light(patch, material, lighting_->openness_at(x, y, surfel));
  }

  // A pixel of which two quarters, and the centre, have been traced.
  [[nodiscard]] Eigen::Vector3f mixed(const TracedPixel& pixel, const PixelRays& rays) const {
    const std::array<SurfaceHit, 3> hits{
        surfaces_->at(pixel.at.x, pixel.at.y).hit, pixel.hits[0], pixel.hits[1]};
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::array<bool, 3> done{};
    for (std::size_t first = 0; first < hits.size(); ++first) {
      if (done[first] || !hits[first].valid()) continue;
      const SurfaceTriangle triangle = scene_->triangle(hits[first]);
      const Material& material = world_->materials[triangle.material];
      const PixelSurface surface(triangle, material, cameras_->of_row(pixel.at.y), rays);
      // Most often several of the rays show the same triangle, in the same light.
      Eigen::Vector3f albedo = Eigen::Vector3f::Zero();
      std::optional<float> light;
      for (std::size_t k = first; k < hits.size(); ++k) {
        const bool same =
            hits[k].object == hits[first].object && hits[k].triangle == hits[first].triangle;
        if (!same) continue;
        done[k] = true;
        const SurfacePatch patch =
            k == 0 ? surface.center() : surface.quarter(pixel.quarters[k - 1]);
        albedo += patch.albedo;
        if (light) continue;
        const Surfel surfel{hits[k], triangle.material, patch.point, patch.normal};
        const Openness openness = lighting_->openness_at(pixel.at.x, pixel.at.y, surfel);
        light = light_on(*world_, patch.point, patch.normal, openness);
      }
      sum += lit(albedo, material, *light);
    }
    return sum / static_cast<float>(hits.size());
  }

 private:
  [[nodiscard]] Eigen::Vector3f in_light(const SurfacePatch& patch,
                                         const Material& material,
                                         const Openness& openness) const {
    return lit(patch.albedo, material, light_on(*world_, patch.point, patch.normal, openness));
  }

  const World* world_;
  const RayScene* scene_;
  const SurfaceBuffer* surfaces_;
  const Lighting* lighting_;
  const RowCameras* cameras_;
};

// The pixel's rays with all four quarters at its centre.
PixelRays without_extent(PixelRays rays) {
  rays.quarters.fill(rays.center);
  return rays;
}

// Traces two opposite quarters of some pixels, alternating between the diagonals. Rays of one
// moment and of neighbouring pixels are traced together, because their paths are similar.
std::vector<TracedPixel> trace_quarters(const RayScene& scene,
                                        const RowCameras& cameras,
                                        const cv::Mat2f& quarter_rays,
                                        const std::vector<cv::Point>& pixels) {
  std::vector<TracedPixel> traced(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const bool falling = (pixels[i].x + pixels[i].y) % 2 == 0;
    traced[i].at = pixels[i];
    if (!falling) traced[i].quarters = {1, 2};
  }
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t first = 0; first < traced.size(); first += kRays) {
      const std::size_t count = std::min(kRays, traced.size() - first);
      std::array<Ray, kRays> packet;
      for (std::size_t i = 0; i < count; ++i) {
        const TracedPixel& pixel = traced[first + i];
        const std::size_t quarter = pixel.quarters[k];
        const MovingCamera::Moment& moment = cameras.of_row(pixel.at.y).quarters[quarter];
        const int dx = static_cast<int>(quarter % 2), dy = static_cast<int>(quarter / 2);
        packet[i].origin = moment.origin;
        packet[i].direction =
            moment.R_world_camera * ray_of(quarter_rays(2 * pixel.at.y + dy, 2 * pixel.at.x + dx));
      }
      // The upper quarters are all of one moment, and so are the lower ones.
      const std::size_t moment = kQuarterMoments[traced[first].quarters[k]];
      const std::array<SurfaceHit, kRays> found = scene.first_hits({packet.data(), count}, moment);
      for (std::size_t i = 0; i < count; ++i) traced[first + i].hits[k] = found[i];
    }
  }
  return traced;
}

// The pixels that a mask marks, those of small blocks together.
std::vector<cv::Point> marked_pixels(const cv::Mat1b& mask) {
  constexpr int kBlock = 4;
  std::vector<cv::Point> pixels;
  for (int top = 0; top < mask.rows; top += kBlock) {
    for (int left = 0; left < mask.cols; left += kBlock) {
      for (int y = top; y < std::min(top + kBlock, mask.rows); ++y) {
        for (int x = left; x < std::min(left + kBlock, mask.cols); ++x) {
          if (mask(y, x) != 0) pixels.emplace_back(x, y);
        }
      }
    }
  }
  return pixels;
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const World> world,
                   const CameraModel& camera,
                   const RenderOptions& options)
    : geometry_(std::move(world)),
      options_(options),
      focal_length_px_(static_cast<float>(camera.fx)),
      rays_(pixel_rays(camera)),
      quarter_rays_(pixel_rays(with_quartered_pixels(camera))) {}

PixelRays Renderer::pixel_rays_at(int x, int y) const {
  const cv::Vec2f* upper = quarter_rays_.ptr<cv::Vec2f>(2 * y) + 2 * x;
  const cv::Vec2f* lower = quarter_rays_.ptr<cv::Vec2f>(2 * y + 1) + 2 * x;
  const PixelRays rays{ray_of(rays_(y, x)),
                       {ray_of(upper[0]), ray_of(upper[1]), ray_of(lower[0]), ray_of(lower[1])}};
  return options_.antialiasing ? rays : without_extent(rays);
}

DepthImage Renderer::depth(const Exposure& exposure) const {
  const SurfaceBuffer surfaces = trace_surfaces(RayScene(geometry_, exposure), exposure, rays_);
  DepthImage depth(cv::Mat1f(rays_.size()));
  for (int y = 0; y < rays_.rows; ++y) {
    for (int x = 0; x < rays_.cols; ++x) depth.mat(y, x) = surfaces.at(x, y).hit.t;
  }
  return depth;
}

RenderedImage Renderer::render(const Exposure& exposure) const {
  STILLMAP_CHECK(exposure.rows.empty() || std::ssize(exposure.rows) == rays_.rows);
  const World& world = geometry_.world();
  const RayScene scene(geometry_, exposure);
  const SurfaceBuffer surfaces = trace_surfaces(scene, exposure, rays_);
  const Lighting lighting(scene, world, surfaces, options_.light);
  const RowCameras cameras(exposure);
  const Painter painter(world, scene, surfaces, lighting, cameras);

  RenderedImage image{ColorImage(cv::Mat3b(rays_.size())),
                      DepthImage(cv::Mat1f(rays_.size())),
                      cv::Mat1b(rays_.size())};
  const auto set_color = [&](int x, int y, const Eigen::Vector3f& color) {
    image.color.mat(y, x) = {to_byte(color[0]), to_byte(color[1]), to_byte(color[2])};
  };
  const cv::Mat1b mixed = options_.antialiasing
                              ? mixed_pixels(surfaces, scene, exposure, focal_length_px_)
                              : cv::Mat1b::zeros(rays_.size());
  for (int y = 0; y < rays_.rows; ++y) {
    for (int x = 0; x < rays_.cols; ++x) {
      const SurfaceHit& hit = surfaces.at(x, y).hit;
      image.depth.mat(y, x) = hit.t;
      image.ids(y, x) = hit.valid() ? scene.mask_id(hit.object) : std::uint8_t{0};
      if (mixed(y, x) == 0) set_color(x, y, painter.plain(x, y, pixel_rays_at(x, y)));
    }
  }
  const std::vector<cv::Point> pixels = marked_pixels(mixed);
  for (const TracedPixel& pixel : trace_quarters(scene, cameras, quarter_rays_, pixels)) {
    const cv::Point& p = pixel.at;
    set_color(p.x, p.y, painter.mixed(pixel, pixel_rays_at(p.x, p.y)));
  }
  return image;
}

}  // namespace stillmap
