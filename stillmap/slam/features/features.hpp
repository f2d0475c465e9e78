// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "stillmap/slam/features/descriptor.hpp"
#include "stillmap/slam/features/feature_grid.hpp"

namespace stillmap {

/// Features of less trust are matched with known landmarks only: they make none.
inline constexpr float kTrustOfLandmarks = 0.5F;

/// The point features of one frame, as parallel arrays of equal length. Never changed after
/// construction.
struct Features {
  std::vector<Eigen::Vector2f> raw_px;    ///< raw pixels in the image
  std::vector<Eigen::Vector2f> ideal_px;  ///< without lens distortion
  std::vector<float> sensor_depth_m;      ///< along the optical axis; 0 where unknown
  // The same, moved to the time of the frame's pose (rolling shutter). All geometry uses these.
  std::vector<Eigen::Vector2f> px;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> level;  ///< of the image pyramid; 0 is the full resolution
  std::vector<float> angle_deg;     ///< orientation, [0, 360)
  std::vector<Descriptor> descriptors;
  /// How likely each is on something static, in (0, 1]: its weight in the pose. Empty: all are.
  std::vector<float> trust;
  FeatureGrid grid;  ///< over px

  [[nodiscard]] std::size_t size() const { return px.size(); }
  [[nodiscard]] float trust_of(std::size_t i) const { return trust.empty() ? 1.0F : trust[i]; }
};

using FeaturesPtr = std::shared_ptr<const Features>;

}  // namespace stillmap
