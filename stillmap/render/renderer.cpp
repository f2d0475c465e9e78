// SPDX-License-Identifier: Apache-2.0
#include "stillmap/render/renderer.hpp"

#include <algorithm>

#include "stillmap/core/error.hpp"
#include "stillmap/render/shading.hpp"
#include "stillmap/render/surface_buffer.hpp"

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

// All that colouring the pixels of one image takes.
class Painter {
 public:
  Painter(const World& world,
          const RayScene& scene,
          const SurfaceBuffer& surfaces,
          const Lighting& lighting,
          const MovingCamera& camera)
      : world_(&world),
        scene_(&scene),
        surfaces_(&surfaces),
        lighting_(&lighting),
        camera_(&camera) {}

  // A pixel that shows one smooth surface.
  [[nodiscard]] Eigen::Vector3f plain(int x, int y, const PixelRays& rays) const {
    const Surfel& surfel = surfaces_->at(x, y);
    if (!surfel.hit.valid()) return Eigen::Vector3f::Zero();
    const SurfaceTriangle triangle = scene_->triangle(surfel.hit);
    const Material& material = world_->materials[triangle.material];
    const SurfacePatch patch = plain_patch(triangle, material, *camera_, rays);
    return in_light(patch, material, lighting_->openness_at(x, y, surfel));
  }

  // A pixel that may show several.
  [[nodiscard]] Eigen::Vector3f mixed(int x, int y, const PixelRays& rays) const {
    std::array<Ray, 4> quarter_rays;
    for (std::size_t k = 0; k < 4; ++k) {
      const MovingCamera::Moment& moment = camera_->quarters[k];
      quarter_rays[k] = {
          moment.origin, moment.R_world_camera * rays.quarters[k], moment.time, 1e9F};
    }
    const std::array<SurfaceHit, kRays> hits = scene_->first_hits(quarter_rays);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      if (!hits[k].valid()) continue;
      const SurfaceTriangle triangle = scene_->triangle(hits[k]);
      const Material& material = world_->materials[triangle.material];
      const SurfacePatch patch = quarter_patch(triangle, material, *camera_, rays, k);
      const Surfel surfel{hits[k], triangle.material, patch.point, patch.normal};
      sum += in_light(patch, material, lighting_->openness_at(x, y, surfel));
    }
    return 0.25F * sum;
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
  const MovingCamera* camera_;
};

// With all four quarters in the pixel's centre.
PixelRays without_extent(PixelRays rays) {
  rays.quarters.fill(rays.center);
  return rays;
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

RenderedImage Renderer::render(const Exposure& exposure) const {
  const World& world = geometry_.world();
  const RayScene scene(geometry_, exposure);
  const SurfaceBuffer surfaces = trace_surfaces(scene, exposure.T_world_camera, rays_);
  const cv::Mat1b mixed = mixed_pixels(surfaces, scene, exposure, focal_length_px_);
  const Lighting lighting(scene, world, surfaces, options_.light);
  const MovingCamera camera(exposure);
  const Painter painter(world, scene, surfaces, lighting, camera);

  RenderedImage image{ColorImage(cv::Mat3b(rays_.size())),
                      DepthImage(cv::Mat1f(rays_.size())),
                      cv::Mat1b(rays_.size())};
  for (int y = 0; y < rays_.rows; ++y) {
    const cv::Vec2f* upper = quarter_rays_.ptr<cv::Vec2f>(2 * y);
    const cv::Vec2f* lower = quarter_rays_.ptr<cv::Vec2f>(2 * y + 1);
    for (int x = 0; x < rays_.cols; ++x) {
      const Surfel& surfel = surfaces.at(x, y);
      image.depth.mat(y, x) = surfel.hit.t;
      image.ids(y, x) = surfel.hit.valid() ? scene.mask_id(surfel.hit.object) : std::uint8_t{0};
      PixelRays rays{ray_of(rays_(y, x)),
                     {ray_of(upper[2 * x]),
                      ray_of(upper[2 * x + 1]),
                      ray_of(lower[2 * x]),
                      ray_of(lower[2 * x + 1])}};
      const bool several = options_.antialiasing && mixed(y, x) != 0;
      if (!options_.antialiasing) rays = without_extent(rays);
      const Eigen::Vector3f color = several ? painter.mixed(x, y, rays) : painter.plain(x, y, rays);
      image.color.mat(y, x) = {to_byte(color[0]), to_byte(color[1]), to_byte(color[2])};
    }
  }
  return image;
}

}  // namespace stillmap
