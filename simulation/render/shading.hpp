// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "simulation/render/lighting.hpp"
#include "simulation/render/ray_scene.hpp"
#include "simulation/render/triangle_plane.hpp"

namespace stillmap {

/// Rays through a pixel in camera coordinates, z = 1: through its centre and the centres of its
/// four quarters, row by row.
struct PixelRays {
  Eigen::Vector3f center;
  std::array<Eigen::Vector3f, 4> quarters;
};

/// The position and axes of a camera at the moments of an exposure at which colour is sampled.
class MovingCamera {
 public:
  explicit MovingCamera(const CameraExposure& exposure);

  struct Moment {
    Eigen::Matrix3f R_world_camera;
    Eigen::Vector3f origin;
    float time;
  };
  /// The times of the quarters of a pixel.
  std::array<Moment, 4> quarters;
  Moment middle;
  Eigen::Vector3f translation;  ///< while the shutter is open
  Eigen::Matrix3f turn;         ///< the difference of the axes
  bool moves = false;
};

/// The unlit colour of the surface in a pixel, with its position and normal.
struct SurfacePatch {
  Eigen::Vector3f albedo;  ///< red, green, blue in [0, 255]
  Eigen::Vector3f point;
  Eigen::Vector3f normal;  ///< of the smooth surface, towards the camera
};

/// The part of a triangle's plane that a pixel covers during an exposure: its centre on the
/// texture, the steps from one quarter to the next, and the motion of the texture.
class PixelSurface {
 public:
  /// The arguments must outlive the object.
  PixelSurface(const SurfaceTriangle& triangle,
               const Material& material,
               const MovingCamera& camera,
               const PixelRays& rays);

  /// The patch of a pixel that shows only this plane during the whole exposure.
  [[nodiscard]] SurfacePatch whole() const;

  /// The patch at the pixel's centre in the middle of the exposure.
  [[nodiscard]] SurfacePatch center() const;

  /// The patch at quarter k of the pixel at the moment of that quarter.
  [[nodiscard]] SurfacePatch quarter(std::size_t k) const;

 private:
  /// The patch at one ray, with the plane at the time of the ray.
  [[nodiscard]] SurfacePatch patch_at(const TrianglePlane& plane,
                                      const PlaneMeeting& meeting) const;

  const SurfaceTriangle* triangle_;
  const Material* material_;
  const MovingCamera* camera_;
  const PixelRays* rays_;
  TrianglePlane plane_;
  PlaneMeeting middle_;
  Eigen::Vector2f across_, down_;  // from one quarter to the next, on the picture
  Eigen::Vector2f motion_ = Eigen::Vector2f::Zero();
  float level_ = 0.F;
};

/// The colour that a camera records of `albedo` under a light.
[[nodiscard]] Eigen::Vector3f lit(const Eigen::Vector3f& albedo,
                                  const Material& material,
                                  float light);

}  // namespace stillmap
