// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "simulation/render/lighting.hpp"
#include "simulation/render/ray_scene.hpp"
#include "simulation/render/triangle_plane.hpp"

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
  /// When a pixel's quarters are taken.
  std::array<Moment, 4> quarters;
  Moment middle;
  Eigen::Vector3f translation;  ///< while the shutter is open
  Eigen::Matrix3f turn;         ///< the difference of the axes
  bool moves = false;
};

/// The colour of the piece of surface in a pixel, not yet lit; and where it is and faces.
struct SurfacePatch {
  Eigen::Vector3f albedo;  ///< red, green, blue in [0, 255]
  Eigen::Vector3f point;
  Eigen::Vector3f normal;  ///< of the smooth surface, towards the camera
};

/// What a pixel covers of a triangle's plane during an exposure: its middle on the picture, the
/// steps from one quarter to the next, and how far the picture moves.
class PixelSurface {
 public:
  /// The arguments must outlive this.
  PixelSurface(const SurfaceTriangle& triangle,
               const Material& material,
               const MovingCamera& camera,
               const PixelRays& rays);

  /// For a pixel all of which shows the plane during the whole exposure.
  [[nodiscard]] SurfacePatch whole() const;

  /// What the pixel's centre shows of the plane half way through the exposure.
  [[nodiscard]] SurfacePatch center() const;

  /// What quarter k of the pixel shows of the plane at its moment.
  [[nodiscard]] SurfacePatch quarter(std::size_t k) const;

 private:
  /// What one ray shows of the plane, as it is at the ray's time.
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

/// What a camera records of `albedo` in a light.
[[nodiscard]] Eigen::Vector3f lit(const Eigen::Vector3f& albedo,
                                  const Material& material,
                                  float light);

}  // namespace stillmap
