// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "simulation/render/lighting.hpp"
#include "simulation/render/ray_scene.hpp"
#include "simulation/render/shading.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The images of a perfect camera.
struct RenderedImage {
  ColorImage color;
  DepthImage depth;  ///< exact z at the pixel's centre; 0 where there is no surface
  cv::Mat1b ids;     ///< mask id at the pixel's centre; 0 for objects that cannot move
};

struct RenderOptions {
  LightOptions light;
  bool antialiasing = true;  ///< if false, colour comes from the pixel's centre, too
};

/// Renders a world by ray tracing. Depth and ids come from the ray through each pixel's centre in
/// the middle of the exposure. Colour is averaged over the pixel and the exposure: from three rays
/// in pixels with several surfaces, else analytically on the plane of the one surface. Immutable
/// after construction; safe to use from several threads.
class Renderer {
 public:
  /// `world` must not be null. `camera` may have distortion.
  Renderer(std::shared_ptr<const World> world,
           const CameraModel& camera,
           const RenderOptions& options = {});

  [[nodiscard]] RenderedImage render(const Exposure& exposure) const;
  /// The depth of render() alone, for a fraction of the time.
  [[nodiscard]] DepthImage depth(const Exposure& exposure) const;

 private:
  [[nodiscard]] PixelRays pixel_rays_at(int x, int y) const;

  WorldGeometry geometry_;
  RenderOptions options_;
  float focal_length_px_;
  cv::Mat2f rays_;          // of pixel centres
  cv::Mat2f quarter_rays_;  // of the four quarters' centres, twice as wide and high
};

}  // namespace stillmap
