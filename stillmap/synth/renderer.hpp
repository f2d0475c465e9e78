// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/camera.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/synth/scene.hpp"

namespace stillmap {

/// What a perfect camera sees.
struct RenderedImage {
  ColorImage color;
  DepthImage depth;  ///< exact z of the ray through the pixel's centre; 0 where it meets nothing
};

/// Casts rays into a scene. Depth comes from the ray through each pixel's centre, colour from four
/// rays a pixel with textures filtered to their footprint. Immutable after construction, so that
/// one renderer may serve several threads.
class Renderer {
 public:
  /// `scene` is not null. `camera` may be distorted.
  Renderer(std::shared_ptr<const Scene> scene, const CameraModel& camera);

  /// The image from a pose in the scene's world. `threads` >= 1; the result does not depend on it.
  [[nodiscard]] RenderedImage render(const Eigen::Isometry3d& T_world_camera,
                                     int threads = 1) const;

 private:
  /// The pixels of a square block and the bounds of their rays: min <= x/z, y/z <= max.
  struct Tile {
    cv::Rect pixels;
    Eigen::Vector2d min;
    Eigen::Vector2d max;
  };

  [[nodiscard]] Tile make_tile(const cv::Rect& pixels) const;

  std::shared_ptr<const Scene> scene_;
  cv::Mat2f rays_;      // of pixel centres
  cv::Mat2f sub_rays_;  // of the four quarter-pixel centres, twice as wide and high
  std::vector<Tile> tiles_;
};

}  // namespace stillmap
