// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "simulation/render/ray_scene.hpp"

namespace stillmap {

/// The surface at a pixel's centre in the middle of the exposure.
struct Surfel {
  SurfaceHit hit;
  MaterialId material = 0;
  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< in the world
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< of the triangle, towards the camera
};

/// Whether two points are on one smooth surface with one material, so that light and texture are
/// continuous between them.
[[nodiscard]] bool continuous(const Surfel& a, const Surfel& b);

/// A row-major image of surfels.
struct SurfaceBuffer {
  int width = 0;
  int height = 0;
  std::vector<Surfel> surfels;

  [[nodiscard]] const Surfel& at(int x, int y) const {
    return surfels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x)];
  }
};

/// The surfels of a camera whose pixel centres look along `rays` = (x/z, y/z), in the middle of the
/// exposure of each row.
[[nodiscard]] SurfaceBuffer trace_surfaces(const RayScene& scene,
                                           const Exposure& exposure,
                                           const cv::Mat2f& rays);

/// 255 where a pixel may show more than one smooth surface while the shutter is open: along the
/// edges between surfaces, widened by the motion of the image there.
[[nodiscard]] cv::Mat1b mixed_pixels(const SurfaceBuffer& surfaces,
                                     const RayScene& scene,
                                     const Exposure& exposure,
                                     float focal_length_px);

}  // namespace stillmap
