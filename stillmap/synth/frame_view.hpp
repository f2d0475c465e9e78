// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/synth/scene.hpp"

namespace stillmap {

/// A scene's box as one camera pose sees it.
struct BoxView {
  const SceneBox* box = nullptr;
  Eigen::Matrix3d R_box_camera;
  Eigen::Vector3d camera_in_box;
  Eigen::Vector3d lamp_in_box;
  std::array<Eigen::Vector3d, 8> corners_camera;
};

/// Which face of which box: 0 for none, else 6 * box + face + 1.
struct SurfaceId {
  std::int32_t value = 0;
  [[nodiscard]] bool valid() const { return value > 0; }
  [[nodiscard]] std::size_t box() const { return static_cast<std::size_t>((value - 1) / 6); }
  [[nodiscard]] int face() const { return (value - 1) % 6; }
  bool operator==(const SurfaceId&) const = default;
};

struct ViewHit {
  SurfaceId surface;
  double depth = 0;  ///< along the optical axis
};

/// Rays of the form (x, y, 1) in camera coordinates; four of them make a pixel.
using SubRays = std::array<Eigen::Vector3d, 4>;

/// A scene seen from one pose, with what all its rays share worked out beforehand.
class FrameView {
 public:
  FrameView(const Scene& scene, const Eigen::Isometry3d& T_world_camera);

  /// Boxes that rays with min <= (x, y) <= max may meet, in the scene's order; a superset.
  [[nodiscard]] std::vector<std::uint32_t> boxes_within(const Eigen::Vector2d& min,
                                                        const Eigen::Vector2d& max) const;

  /// The nearest surface along a ray among the boxes `candidates`.
  [[nodiscard]] ViewHit nearest(const Eigen::Vector3d& ray,
                                std::span<const std::uint32_t> candidates) const;

  /// Colour of a pixel all of whose rays meet `surface`: red, green, blue in [0, 255].
  [[nodiscard]] Eigen::Vector3f shade_plain(SurfaceId surface, const SubRays& rays) const;

  /// Colour of a pixel whose rays may meet different surfaces or nothing (black).
  [[nodiscard]] Eigen::Vector3f shade_mixed(const SubRays& rays,
                                            std::span<const std::uint32_t> candidates) const;

 private:
  /// Where the rays of a pixel cross the plane of a face.
  struct Patch {
    std::array<TexturePoint, 4> at;
    float level;  ///< of the texture's pyramid
    float light;  ///< Lambert's factor, in [0, 1]
  };
  [[nodiscard]] Patch patch_on(SurfaceId surface, const SubRays& rays) const;
  [[nodiscard]] const MipTexture& texture_of(SurfaceId surface) const;

  const Scene* scene_;
  std::vector<BoxView> boxes_;
};

}  // namespace stillmap
