// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "simulation/render/surface_buffer.hpp"

namespace stillmap {

/// Most lamps that a world may have.
inline constexpr std::size_t kMostLamps = 3;

/// How much of the light reaches a point: of each lamp the share that nothing hides, and of the
/// light from everywhere the share that what is near leaves open; in [0, 1].
struct Openness {
  std::array<float, kMostLamps> lamps{};
  float around = 1.F;
};

/// Which effects of light are rendered.
struct LightOptions {
  bool shadows = true;  ///< cast by lamps, soft, and the darkness of corners
};

/// Shadows of an image, traced at every third pixel each way and smoothed within surfaces.
class Lighting {
 public:
  Lighting(const RayScene& scene,
           const World& world,
           const SurfaceBuffer& surfaces,
           const LightOptions& options);

  /// What reaches a surfel near pixel (x, y), from the samples around that lie on its surface.
  [[nodiscard]] Openness openness_at(int x, int y, const Surfel& surfel) const;

 private:
  struct Sample {
    const Surfel* surfel;
    Openness openness;
  };
  [[nodiscard]] const Sample& sample_at(int x, int y) const {
    return samples_[static_cast<std::size_t>(y * width_ + x)];
  }
  void trace(const RayScene& scene, const World& world);
  void smooth(int dx, int dy);

  int width_ = 0;  // of the samples
  int height_ = 0;
  std::vector<Sample> samples_;
};

/// The light on a surface with a normal at a point, 1 being full.
[[nodiscard]] float light_on(const World& world,
                             const Eigen::Vector3f& point,
                             const Eigen::Vector3f& normal,
                             const Openness& openness);

}  // namespace stillmap
