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

/// What a perfect camera sees.
struct RenderedImage {
  ColorImage color;
  DepthImage depth;  ///< exact z of the ray through the pixel's centre; 0 where it meets nothing
  cv::Mat1b ids;     ///< mask id of what that ray meets; 0 for what cannot move
};

struct RenderOptions {
  LightOptions light;
  bool antialiasing = true;  ///< else colour, too, comes from the pixel's centre alone
};

/// Casts rays into a world. Depth and ids come from the ray through each pixel's centre half way
/// through the exposure. Colour is averaged over the pixel and the exposure: from three rays where
/// several surfaces show, else worked out on the one surface's plane. Immutable after construction,
/// so that one renderer may serve several threads.
class Renderer {
 public:
  /// `world` is not null. `camera` may be distorted.
  Renderer(std::shared_ptr<const World> world,
           const CameraModel& camera,
           const RenderOptions& options = {});

  [[nodiscard]] RenderedImage render(const Exposure& exposure) const;

 private:
  [[nodiscard]] PixelRays pixel_rays_at(int x, int y) const;

  WorldGeometry geometry_;
  RenderOptions options_;
  float focal_length_px_;
  cv::Mat2f rays_;          // of pixel centres
  cv::Mat2f quarter_rays_;  // of the four quarters' centres, twice as wide and high
};

}  // namespace stillmap
