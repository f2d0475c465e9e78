// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "stillmap/render/lighting.hpp"
#include "stillmap/render/ray_scene.hpp"

namespace stillmap {

/// Rays through a pixel in camera coordinates, z = 1: its centre and its four quarters' centres, in
/// rows.
struct PixelRays {
  Eigen::Vector3f center;
  std::array<Eigen::Vector3f, 4> quarters;
};

/// A camera's place and axes at the times within an exposure at which colour is taken.
class MovingCamera {
 public:
  explicit MovingCamera(const Exposure& exposure);

  struct Moment {
    Eigen::Matrix3f R_world_camera;
    Eigen::Vector3f origin;
    float time;
  };
  /// The four times at which a pixel's quarters are taken, spread over the exposure.
  std::array<Moment, 4> quarters;
  Moment open, middle, close;
  Eigen::Vector3f translation;  ///< from open to close
  Eigen::Matrix3f turn;         ///< the difference of the axes
  bool moves = false;
};

/// The colour of the piece of surface in a pixel, not yet lit; and where it is and faces.
struct SurfacePatch {
  Eigen::Vector3f albedo;  ///< red, green, blue in [0, 255]
  Eigen::Vector3f point;
  Eigen::Vector3f normal;  ///< of the smooth surface, towards the camera
};

/// A pixel all of which shows the plane of `triangle` during the whole exposure.
[[nodiscard]] SurfacePatch plain_patch(const SurfaceTriangle& triangle,
                                       const Material& material,
                                       const MovingCamera& camera,
                                       const PixelRays& rays);

/// What a pixel's quarter number `quarter` shows of the plane of `triangle`.
[[nodiscard]] SurfacePatch quarter_patch(const SurfaceTriangle& triangle,
                                         const Material& material,
                                         const MovingCamera& camera,
                                         const PixelRays& rays,
                                         std::size_t quarter);

/// What a camera records of `albedo` in a light.
[[nodiscard]] Eigen::Vector3f lit(const Eigen::Vector3f& albedo,
                                  const Material& material,
                                  float light);

}  // namespace stillmap
