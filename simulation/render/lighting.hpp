// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "simulation/render/surface_buffer.hpp"

namespace stillmap {

/// The greatest number of lamps in a world.
inline constexpr std::size_t kMostLamps = 3;

/// The shares of light that reach a point, in [0, 1]: for each lamp the visible share, and for
/// ambient light the share that near surfaces leave open.
struct Openness {
  std::array<float, kMostLamps> lamps{};
  float around = 1.F;
};

/// The effects of light that are rendered.
struct LightOptions {
  bool shadows = true;  ///< soft shadows of lamps, and ambient occlusion
};

/// The shadows of an image, traced at every third pixel of every third row and smoothed within
/// surfaces.
class Lighting {
 public:
  Lighting(const RayScene& scene,
           const World& world,
           const SurfaceBuffer& surfaces,
           const LightOptions& options);

  /// The openness of a surfel near pixel (x, y), from the samples around it on the same surface.
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

  int width_ = 0;  // of the grid of samples
  int height_ = 0;
  std::vector<Sample> samples_;
};

/// The light at a point of a surface with a normal; 1 is full light.
[[nodiscard]] float light_on(const World& world,
                             const Eigen::Vector3f& point,
                             const Eigen::Vector3f& normal,
                             const Openness& openness);

}  // namespace stillmap
